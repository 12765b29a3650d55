#include "rig.h"

#include "x/encoded_text.h"
#include "x/rig_fields.h"

#include <cmath>
#include <span>

namespace bendy::converter::x_out {
namespace {

/// Writes the fields that rig_fields.h walks, a line each.
class FieldWriter {
public:
    explicit FieldWriter(Text& text) : text_(text) {}

    void word(const char* /*field*/, std::span<const std::string_view> words, std::uint8_t& number) {
        string(std::string(words[number]));
    }
    template <class Integer>
    void integer(const char* /*field*/, Integer& number, std::uint32_t /*most*/) {
        text_.line(std::to_string(number) + ';');
    }
    void number(const char* /*field*/, float& number, float /*low*/, float /*high*/) {
        text_.begin_line();
        text_.add(number).add(";");
        text_.end_line();
    }
    template <std::size_t N>
    void numbers(const char* /*field*/, std::array<float, N>& numbers, float /*low*/, float /*high*/) {
        text_.begin_line();
        for (std::size_t i = 0; i < N; ++i) text_.add(numbers[i]).add(i + 1 < N ? "," : ";");
        text_.end_line();
    }
    void ranges(const char* field, std::array<float, 3>& numbers) {
        std::array<float, 3> finite = numbers;
        for (float& number : finite) number = std::isinf(number) ? std::copysign(x::kMost, number) : number;
        this->numbers(field, finite, 0.0f, 0.0f);
    }
    void text(const char* /*field*/, std::string& text) { string(x::encode_text(text)); }
    void frame(const char* /*field*/, std::string& identifier) { string(identifier); }
    void weights(const char* /*field*/, std::vector<std::pair<std::string, float>>& weights) {
        text_.line(std::to_string(weights.size()) + ';');
        for (std::size_t i = 0; i < weights.size(); ++i) {
            text_.begin_line();
            text_.add('"' + weights[i].first + "\";").add(weights[i].second).add(i + 1 < weights.size() ? ";," : ";;");
            text_.end_line();
        }
    }

private:
    void string(const std::string& text) { text_.line('"' + text + "\";"); }

    Text& text_;
};

}  // namespace

void write_constraints(const Joint& joint, Text& text) {
    for (LimitRecord limit : joint.limits) {
        text.open("BendyConstraint");
        FieldWriter fields(text);
        x::walk_constraint(fields, limit);
        text.close();
    }
}

void write_chains(const Scene& scene, const Names& names, Text& text) {
    const auto name_of = [&](std::uint32_t joint) { return joint == kNone ? std::string() : names.joints[joint]; };
    for (const Chain& source : scene.chains) {
        x::IkChain chain;
        chain.name = source.name;
        chain.start = name_of(source.record.start);
        chain.effector = name_of(source.record.effector);
        chain.target = name_of(source.record.target);
        chain.pole = name_of(source.record.pole);
        chain.record = source.record;
        for (const Chain::Weight& weight : source.weights)
            chain.weights.emplace_back(name_of(weight.joint), weight.weight);
        chain.extras = source.extras;
        text.open("BendyIkChain");
        FieldWriter fields(text);
        x::walk_chain(fields, chain);
        text.close();
    }
}

}  // namespace bendy::converter::x_out
