// Compiles nlohmann's parser and its formatting of numbers and strings. Beside it, tinygltf does so for itself, and
// tools/cli/files/output.cpp reads a glTF file without making values of it.
#include <bendy/json/json.h>

#include <nlohmann/json.hpp>

#include <algorithm>

namespace bendy {

/// Makes values of what a parser has read.
struct JsonMaker {
    template <JsonOrder order>
    static auto& members(BasicJson<order>& object) {
        return *object.value_.object;
    }
    template <JsonOrder order>
    static void finish(BasicJson<order>& object) {
        object.finish_object();
    }
};

namespace {

template <JsonOrder order>
class Handler : public nlohmann::json_sax<nlohmann::json> {
public:
    using Value = BasicJson<order>;
    explicit Handler(JsonFault* fault) : fault_(fault) {}

    [[nodiscard]] Value take() { return std::move(root_); }

    bool null() override { return add(Value()); }
    bool boolean(bool value) override { return add(value); }
    bool number_integer(std::int64_t value) override { return add(value); }
    bool number_unsigned(std::uint64_t value) override { return add(value); }
    bool number_float(double value, const std::string& /*text*/) override { return add(value); }
    bool string(std::string& value) override { return add(Value(std::move(value))); }
    bool binary(binary_t& /*value*/) override { return false; }
    bool start_object(std::size_t /*size*/) override { return open(Value::object()); }
    bool key(std::string& name) override {
        JsonMaker::members(*open_.back()).push_back(std::make_unique<typename Value::Member>(std::move(name), Value()));
        return true;
    }
    bool end_object() override {
        JsonMaker::finish(*open_.back());
        open_.pop_back();
        return true;
    }
    bool start_array(std::size_t /*size*/) override { return open(Value::array()); }
    bool end_array() override {
        open_.pop_back();
        return true;
    }
    bool parse_error(std::size_t at, const std::string& /*token*/, const nlohmann::detail::exception& error) override {
        constexpr int kOutOfRange = 406;
        if (fault_ != nullptr) *fault_ = {at, error.what(), error.id == kOutOfRange};
        return false;
    }

private:
    bool add(Value value) {
        place(std::move(value));
        return true;
    }
    Value* place(Value value) {
        Value* at = &root_;
        if (!open_.empty() && open_.back()->is_array()) {
            open_.back()->push_back(std::move(value));
            return &open_.back()->back();
        }
        if (!open_.empty()) at = &JsonMaker::members(*open_.back()).back()->value;
        *at = std::move(value);
        return at;
    }
    bool open(Value value) {
        if (open_.size() == Value::kMostLevels) {
            if (fault_ != nullptr)
                *fault_ = {0, "it is nested deeper than " + std::to_string(Value::kMostLevels) + " levels"};
            return false;
        }
        open_.push_back(place(std::move(value)));
        return true;
    }

    JsonFault* fault_;
    Value root_;
    std::vector<Value*> open_;  // an array grows only where all in it are closed, so these stay in place
};

class Writer {
public:
    Writer(int indentation, bool is_ascii, bool replaces)
        : indentation_(indentation), is_ascii_(is_ascii), replaces_(replaces) {}

    template <JsonOrder order>
    // NOLINTNEXTLINE(misc-no-recursion): the nesting is bounded
    void write(const BasicJson<order>& json, std::size_t depth) {
        switch (json.kind()) {
            case JsonKind::null:
                out_ += "null";
                break;
            case JsonKind::boolean:
                out_ += json.template get<bool>() ? "true" : "false";
                break;
            case JsonKind::negative:
                out_ += std::to_string(json.template get<std::int64_t>());
                break;
            case JsonKind::unsigned_integer:
                out_ += std::to_string(json.template get<std::uint64_t>());
                break;
            case JsonKind::number:
                out_ += nlohmann::json(json.template get<double>()).dump();
                break;
            case JsonKind::string:
                write_string(json.text());
                break;
            case JsonKind::array:
            case JsonKind::object:
                write_list(json, depth);
                break;
        }
    }
    [[nodiscard]] std::string take() { return std::move(out_); }

private:
    void write_string(const std::string& text) {
        const bool is_plain = std::all_of(text.begin(), text.end(),
                                          [](char c) { return c >= 0x20 && c < 0x7f && c != '"' && c != '\\'; });
        if (is_plain) {
            out_.append(1, '"').append(text).append(1, '"');
            return;
        }
        try {
            using Handler = nlohmann::json::error_handler_t;
            out_ += nlohmann::json(text).dump(-1, ' ', is_ascii_, replaces_ ? Handler::replace : Handler::strict);
        } catch (const nlohmann::json::exception& error) {
            throw JsonError(error.what());
        }
    }

    template <JsonOrder order>
    // NOLINTNEXTLINE(misc-no-recursion): the nesting is bounded
    void write_list(const BasicJson<order>& json, std::size_t depth) {
        out_ += json.is_object() ? '{' : '[';
        bool is_first = true;
        for (auto value = json.begin(); value != json.end(); ++value) {
            if (!is_first) out_ += ',';
            is_first = false;
            break_line(depth + 1);
            if (json.is_object()) {
                write_string(value.key());
                out_ += indentation_ < 0 ? ":" : ": ";
            }
            write(*value, depth + 1);
        }
        if (!is_first) break_line(depth);
        out_ += json.is_object() ? '}' : ']';
    }

    void break_line(std::size_t depth) {
        if (indentation_ >= 0) out_.append(1, '\n').append(depth * static_cast<std::size_t>(indentation_), ' ');
    }

    int indentation_;
    bool is_ascii_;
    bool replaces_;
    std::string out_;
};

}  // namespace

template <JsonOrder order>
std::optional<BasicJson<order>> BasicJson<order>::parse(std::string_view text, JsonFault* fault) {
    Handler<order> handler(fault);
    if (!nlohmann::json::sax_parse(text.begin(), text.end(), &handler)) return std::nullopt;
    return handler.take();
}

template <JsonOrder order>
std::string BasicJson<order>::dump(int indentation, bool is_ascii, InvalidText invalid) const {
    Writer writer(indentation, is_ascii, invalid == InvalidText::replaced);
    writer.write(*this, 0);
    return writer.take();
}

bool is_json(std::string_view text) {
    return nlohmann::json::accept(text.begin(), text.end());
}

template std::optional<BasicJson<JsonOrder::sorted>> BasicJson<JsonOrder::sorted>::parse(std::string_view text,
                                                                                         JsonFault* fault);
template std::optional<BasicJson<JsonOrder::written>> BasicJson<JsonOrder::written>::parse(std::string_view text,
                                                                                           JsonFault* fault);
template std::string BasicJson<JsonOrder::sorted>::dump(int indentation, bool is_ascii, InvalidText invalid) const;
template std::string BasicJson<JsonOrder::written>::dump(int indentation, bool is_ascii, InvalidText invalid) const;

}  // namespace bendy
