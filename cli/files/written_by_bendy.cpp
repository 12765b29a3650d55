#include "files/written_by_bendy.h"

#include <bendy/format/chunk.h>
#include <bendy/format/file.h>
#include <bendy/format/read_record.h>
#include <bendy/format/records.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::cli {
namespace {

/// "bendy 0.8.0", and what may follow.
bool is_ours(std::string_view generator) {
    constexpr std::string_view kName = "bendy ";
    return generator.starts_with(kName) && generator.size() > kName.size() && generator[kName.size()] >= '0' &&
           generator[kName.size()] <= '9';
}

/// What of a glTF file's JSON tells who wrote it and what lies beside it. Builds nothing else, however deep it is.
class AssetReader : public nlohmann::json_sax<nlohmann::json> {
public:
    std::string generator;
    std::vector<std::string> buffers;  ///< URIs

    bool key(string_t& name) override {
        if (depth_ == 1) member_ = name;
        field_ = name;
        return true;
    }
    bool string(string_t& text) override {
        if (depth_ == 2 && member_ == "asset" && field_ == "generator") generator = text;
        if (depth_ == 3 && member_ == "buffers" && field_ == "uri" && !text.starts_with("data:"))
            buffers.push_back(text);
        return true;
    }
    bool start_object(std::size_t /*size*/) override { return ++depth_ != 0; }
    bool start_array(std::size_t /*size*/) override { return ++depth_ != 0; }
    bool end_object() override { return depth_-- != 0; }
    bool end_array() override { return depth_-- != 0; }
    bool null() override { return true; }
    bool boolean(bool /*value*/) override { return true; }
    bool number_integer(number_integer_t /*value*/) override { return true; }
    bool number_unsigned(number_unsigned_t /*value*/) override { return true; }
    bool number_float(number_float_t /*value*/, const string_t& /*text*/) override { return true; }
    bool binary(binary_t& /*bytes*/) override { return true; }
    bool parse_error(std::size_t /*at*/, const std::string& /*token*/, const nlohmann::detail::exception&) override {
        return false;
    }

private:
    std::size_t depth_ = 0;
    std::string member_, field_;
};

bool is_bendy(Bytes bytes) {
    return as_text(bytes).starts_with("HEAD");
}

/// VERS is the first chunk in HEAD.
std::string_view generator_of_bendy_file(Bytes bytes) {
    constexpr std::size_t kVersion = 2 * kChunkHeaderSize;  // behind the headers of HEAD and VERS
    constexpr std::size_t kGenerator = 48;                  // in the record, see spec/chunks/VERS.md
    constexpr std::size_t kLength = sizeof(VersionRecord::generator);
    if (bytes.size() < kVersion + kGenerator + kLength || as_text(bytes.subspan(kChunkHeaderSize, 4)) != "VERS")
        return {};
    const std::string_view text = as_text(bytes.subspan(kVersion + kGenerator, kLength));
    return text.substr(0, text.find('\0'));
}

/// The JSON of a glTF file in either container.
std::string_view json_of(Bytes bytes) {
    constexpr std::size_t kJson = 20;  // behind the headers of the file and of its first chunk
    const std::string_view text = as_text(bytes);
    if (!text.starts_with("glTF")) return text;
    std::uint32_t size = 0;
    if (bytes.size() < kJson) return {};
    copy_at(bytes, 12, size);
    return text.substr(kJson, size);
}

AssetReader read_asset(Bytes bytes) {
    AssetReader reader;
    const std::string_view json = json_of(bytes);
    if (!nlohmann::json::sax_parse(json.begin(), json.end(), &reader, nlohmann::json::input_format_t::json, false))
        reader = AssetReader();
    return reader;
}

constexpr std::string_view kXFile = "xof ";

/// The comment in the second line.
std::string_view generator_of_x_file(std::string_view text) {
    constexpr std::string_view kComment = "// ";
    const std::string_view rest = text.substr(std::min(text.find('\n'), text.size() - 1) + 1);
    return rest.starts_with(kComment) ? rest.substr(kComment.size()) : std::string_view();
}

/// %20 as a space.
std::string decoded(std::string_view uri) {
    std::string text;
    for (std::size_t at = 0; at < uri.size(); ++at) {
        unsigned byte = 0;
        const char* digits = uri.data() + at + 1;
        if (uri[at] == '%' && uri.size() - at > 2 && std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2) {
            text += static_cast<char>(byte);
            at += 2;
        } else {
            text += uri[at];
        }
    }
    return text;
}

std::string utf8(const std::filesystem::path& path) {
    const std::u8string text = path.u8string();
    return {text.begin(), text.end()};
}

}  // namespace

bool was_written_by_bendy(const std::filesystem::path& file) {
    const Result<MappedFile> mapped = MappedFile::open(file);
    if (!mapped || mapped->bytes().empty()) return false;
    const Bytes bytes = mapped->bytes();
    if (is_bendy(bytes)) return is_ours(generator_of_bendy_file(bytes));
    if (as_text(bytes).starts_with(kXFile)) return is_ours(generator_of_x_file(as_text(bytes)));
    return is_ours(read_asset(bytes).generator);
}

bool refers_to(const std::filesystem::path& file, const std::filesystem::path& other) {
    const Result<MappedFile> mapped = MappedFile::open(file);
    if (!mapped) return false;
    const std::string name = utf8(other.filename());
    const std::string_view text = as_text(mapped->bytes());
    if (text.starts_with(kXFile)) return text.find('"' + name + '"') != std::string_view::npos;
    const auto buffers = read_asset(mapped->bytes()).buffers;
    return std::any_of(buffers.begin(), buffers.end(), [&](const std::string& uri) { return decoded(uri) == name; });
}

}  // namespace bendy::cli
