#include "record_lines.h"

#include "scene/json_text.h"

#include <bendy/format/charconv.h>
#include <bendy/format/constraint.h>

#include <algorithm>
#include <cmath>

namespace bendy::converter {
namespace {

bool is_same(float a, float b) {
    return bit_cast<std::uint32_t>(a) == bit_cast<std::uint32_t>(b);
}

/// The shortest text of a double. A zero keeps its sign, which JSON integers would lose.
std::string shortest(double number) {
    if (number == 0.0) return std::signbit(number) ? "-0.0" : "0";
    const bool is_handy = std::abs(number) >= 1e-6 && std::abs(number) < 1e15;
    std::array<char, 40> text{};
    char* const end = text.data() + text.size();
    const auto written =
        is_handy ? to_chars(text.data(), end, number, std::chars_format::fixed) : to_chars(text.data(), end, number);
    return {text.data(), written.ptr};
}

double rounded(double number, int digits) {
    std::array<char, 40> text{};
    const auto written =
        to_chars(text.data(), text.data() + text.size(), number, std::chars_format::scientific, digits - 1);
    double back = 0.0;
    from_chars(text.data(), written.ptr, back);
    return back;
}

/// The fewest digits that convert back to the same float.
template <class Back>
std::string fewest_digits(double number, float wanted, Back back) {
    constexpr int kAlwaysEnough = 17;
    int digits = 1;
    while (digits < kAlwaysEnough && !is_same(static_cast<float>(back(rounded(number, digits))), wanted)) ++digits;
    return shortest(rounded(number, digits));
}

std::string degrees(float radians) {
    if (std::isinf(radians)) return "null";
    return fewest_digits(radians / kRadiansPerDegree, radians, to_radians);
}

template <class Number>
std::string list(std::span<const float> numbers, Number number) {
    std::string text;
    for (const float value : numbers) text += (text.empty() ? "" : ", ") + number(value);
    return '[' + text + ']';
}

bool are_same(std::span<const float> a, std::span<const float> b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), is_same);
}

bool is_free(float low, float high) {
    return low == -ConstraintRecord::kFree && high == ConstraintRecord::kFree;
}

}  // namespace

std::string json_text(float number) {
    if (std::isinf(number)) return "null";
    return fewest_digits(number, number, [](double read) { return read; });
}

std::string json_text(std::string_view text) {
    return OrderedJson(text).dump();
}

std::string json_list(std::span<const float> numbers) {
    return list(numbers, [](float number) { return json_text(number); });
}

void RecordLine::add(std::string_view key, const std::string& json) {
    text_ += (text_.empty() ? "" : ", ") + json_text(spelled(key, notation_)) + ": " + json;
}

void RecordLine::add_word(std::string_view key, std::span<const std::string_view> words, std::uint8_t number) {
    if (number != 0) add(key, json_text(spelled(words[number], notation_)));
}

void RecordLine::add_count(std::string_view key, unsigned number) {
    if (number != 0) add(key, std::to_string(number));
}

void RecordLine::add_number(std::string_view key, float number, float usual) {
    if (!is_same(number, usual)) add(key, json_text(number));
}

void RecordLine::add_angle(std::string_view key, float angle, float usual) {
    if (!is_same(angle, usual)) add(key, notation_ == Notation::rig_file ? degrees(angle) : json_text(angle));
}

void RecordLine::add_numbers(std::string_view key, std::span<const float> numbers, std::span<const float> usual) {
    if (!are_same(numbers, usual)) add(key, json_list(numbers));
}

void RecordLine::add_angles(std::string_view key, std::span<const float> angles, std::span<const float> usual) {
    if (!are_same(angles, usual)) add(key, angles_text(angles));
}

void RecordLine::add_range(std::string_view key, float low, float high) {
    if (!is_free(low, high)) add(key, json_list(std::array{low, high}));
}

void RecordLine::add_angle_range(std::string_view key, float low, float high) {
    if (!is_free(low, high)) add(key, angles_text(std::array{low, high}));
}

void RecordLine::add_flag(std::string_view key, std::uint8_t flags, std::uint8_t flag) {
    if ((flags & flag) != 0) add(key, "true");
}

std::string RecordLine::angles_text(std::span<const float> angles) const {
    return notation_ == Notation::rig_file ? list(angles, degrees) : json_list(angles);
}

std::string write_constraint(const ConstraintRecord& constraint, Notation notation) {
    const ConstraintRecord usual;
    const auto model = static_cast<ConstraintModel>(constraint.model);
    RecordLine line(notation);
    line.add("model", json_text(spelled(kValueNames<ConstraintModel>[constraint.model], notation)));
    if (model == ConstraintModel::euler_box) line.add_word("order", kOrderNames, constraint.euler_order);
    line.add_word("scope", kValueNames<ConstraintScope>, constraint.scope);
    line.add_numbers("frame", constraint.frame, usual.frame);
    if (model == ConstraintModel::largest_angle) {
        line.add_angle("angle", constraint.rotation_max[0], usual.rotation_max[0]);
    } else {
        for (std::size_t axis = 0; axis < limited_axes(model); ++axis)
            line.add_angle_range(kAxisNames[axis], constraint.rotation_min[axis], constraint.rotation_max[axis]);
    }
    RecordLine translation(notation);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        translation.add_range(kAxisNames[axis], constraint.translation_min[axis], constraint.translation_max[axis]);
    }
    if (!translation.empty()) line.add("translation", translation.text());
    line.add_numbers("stiffness", constraint.stiffness, usual.stiffness);
    line.add_angles("preferred", constraint.preferred, usual.preferred);
    line.add_angle("soft_zone", constraint.soft_zone);
    line.add_flag("approximated", constraint.flags, kApproximated);
    line.add_flag("proposed", constraint.flags, kProposed);
    line.add_flag("rest_outside", constraint.flags, kRestOutside);
    return line.text();
}

void add_chain_settings(RecordLine& line, const ChainRecord& record) {
    const ChainRecord usual;
    line.add_word("solver", kValueNames<Solver>, record.solver);
    line.add_count("iterations", record.iterations);
    line.add_count("priority", record.priority);
    line.add_number("tolerance", record.tolerance);
    line.add_numbers("pole_vector", record.pole_vector, usual.pole_vector);
    line.add_angle("pole_angle", record.pole_angle);
    line.add_numbers("tip_offset", record.tip_offset, usual.tip_offset);
    line.add_numbers("tip_rotation", record.tip_rotation, usual.tip_rotation);
    line.add_number("position_weight", record.position_weight, usual.position_weight);
    line.add_number("rotation_weight", record.rotation_weight);
    line.add_number("influence", record.influence, usual.influence);
    line.add_number("stretch", record.stretch);
    line.add_number("compress", record.compress);
    line.add_flag("approximated", record.flags, kApproximated);
    line.add_flag("proposed", record.flags, kProposed);
}

void add_standing_settings(RecordLine& line, const StandingPoseRecord& record) {
    line.add("axes", json_list(record.axes));
    line.add_number("ground", record.ground);
    line.add_number("height", record.height);
    line.add_word("evidence", kValueNames<StandingEvidence>, record.evidence);
}

}  // namespace bendy::converter
