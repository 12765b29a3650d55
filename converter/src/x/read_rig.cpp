#include "read_rig.h"

#include "encoded_text.h"
#include "failure.h"
#include "rig/parse_limit.h"
#include "rig_fields.h"
#include "source/transform.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace bendy::converter::x {
namespace {

/// Reads the fields that rig_fields.h walks.
class FieldReader {
public:
    explicit FieldReader(ObjectReader& in) : in_(in) {}

    void word(const char* field, std::span<const std::string_view> words, std::uint8_t& number) {
        const std::string_view text = in_.string();
        const auto found = std::find(words.begin(), words.end(), text);
        if (found == words.end()) in_.refuse(std::string(field) + ": there is no " + quote(text));
        number = static_cast<std::uint8_t>(found - words.begin());
    }
    template <class Integer>
    void integer(const char* field, Integer& number, std::uint32_t most) {
        const std::uint32_t read = in_.integer();
        if (read > most) in_.refuse(std::string(field) + ": at most " + std::to_string(most) + " is allowed");
        number = static_cast<Integer>(read);
    }
    void number(const char* field, float& number, float low, float high) {
        number = in_.number();
        const std::string name(field);
        if (!(number >= low && number <= high)) in_.refuse(name + ": the number is out of range");
    }
    template <std::size_t N>
    void numbers(const char* field, std::array<float, N>& numbers, float low, float high) {
        for (float& component : numbers) number(field, component, low, high);
    }
    void ranges(const char* /*field*/, std::array<float, 3>& numbers) {
        for (float& number : numbers) {
            number = in_.number();
            if (std::abs(number) == kMost) number = std::copysign(LimitRecord::kFree, number);
        }
    }
    void text(const char* /*field*/, std::string& text) { text = decode_text(in_.string()); }
    void frame(const char* /*field*/, std::string& identifier) { identifier = in_.string(); }
    void weights(const char* field, std::vector<std::pair<std::string, float>>& weights) {
        const std::uint32_t count = in_.count(2, "weights");
        for (std::uint32_t i = 0; i < count; ++i) {
            std::string frame(in_.string());
            float weight = 0.0f;
            number(field, weight, 0.0f, 1.0f);
            weights.emplace_back(std::move(frame), weight);
        }
    }

private:
    ObjectReader& in_;
};

/// Makes a rotation unit; one that is already keeps its bits.
void normalise(std::array<float, 4>& rotation, const std::string& place) {
    const UnitQuaternion unit = make_unit({rotation[0], rotation[1], rotation[2], rotation[3]});
    if (unit.length == 0.0) fail(place, "a rotation of it is (0, 0, 0, 0)");
    for (int i = 0; i < 4; ++i) rotation[static_cast<std::size_t>(i)] = unit.value[i];
}

}  // namespace

Constraint read_constraint(ObjectReader& in) {
    Constraint constraint;
    constraint.place = in.place();
    in.head();
    FieldReader fields(in);
    walk_constraint(fields, constraint.record);
    in.end_of("BendyConstraint");
    normalise(constraint.record.frame, constraint.place);
    check_limit_at(constraint.record, constraint.place);
    return constraint;
}

IkChain read_chain(ObjectReader& in) {
    IkChain chain;
    chain.place = in.place();
    in.head();
    FieldReader fields(in);
    walk_chain(fields, chain);
    in.end_of("BendyIkChain");
    normalise(chain.record.tip_rotation, chain.place);
    return chain;
}

}  // namespace bendy::converter::x
