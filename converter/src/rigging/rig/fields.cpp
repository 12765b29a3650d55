#include "fields.h"

#include "scene/failure.h"

#include <bendy/format/clip.h>
#include <bendy/format/names.h>
#include <bendy/format/read_record.h>

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace bendy::converter {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

float shown_in(float value, Notation notation) {
    return notation == Notation::rig_file ? static_cast<float>(value / kRadiansPerDegree) : value;
}

std::string in_digits(float value) {
    return OrderedJson(static_cast<double>(value)).dump();
}

/// Expects a list of `size` elements.
const OrderedJson& need_list_of(std::size_t size, const OrderedJson& value, const std::string& place) {
    if (need_list(value, place).size() != size) {
        fail(place, "expected " + counted(size, "element") + ", found " + std::to_string(value.size()));
    }
    return value;
}

void check_between(float number, float low, float high, const std::string& place) {
    if (number >= low && number <= high) return;
    fail(place, high < std::numeric_limits<float>::max()
                    ? in_digits(number) + " is not between " + in_digits(low) + " and " + in_digits(high)
                    : in_digits(number) + " is less than " + in_digits(low));
}

void read_pair(const OrderedJson& value, const std::string& place, Notation notation, float& low, float& high) {
    need_list_of(2, value, place);
    const float least = value[0].is_null() ? -kInfinity : to_float(value[0], at(place, 0), notation);
    const float most = value[1].is_null() ? kInfinity : to_float(value[1], at(place, 1), notation);
    if (least > most) {
        fail(place, "the minimum " + in_digits(shown_in(least, notation)) + " is above the maximum " +
                        in_digits(shown_in(most, notation)));
    }
    low = least;
    high = most;
}

}  // namespace

std::string spelled(std::string_view word, Notation notation) {
    if (notation != Notation::gltf) return std::string(word);
    std::string text;
    for (std::size_t i = 0; i < word.size(); ++i) {
        const bool starts_word = word[i] == '_' && i + 1 < word.size() && word[i + 1] >= 'a' && word[i + 1] <= 'z';
        text += starts_word ? static_cast<char>(word[++i] - 'a' + 'A') : word[i];
    }
    return text;
}

std::string shown(const OrderedJson& value) {
    if (value.is_string()) return quote(value.text());
    if (value.is_number() || value.is_boolean()) return value.dump();
    return value.type_name();
}

float to_float(const OrderedJson& value, const std::string& place, Notation notation) {
    if (!value.is_number()) fail(place, "expected a number, found " + shown(value));
    const auto number = value.get<double>();
    const double converted = notation == Notation::rig_file ? to_radians(number) : number;
    if (!(std::abs(converted) <= static_cast<double>(std::numeric_limits<float>::max())))
        fail(place, shown(value) + " does not fit a 32-bit float");
    return static_cast<float>(converted);
}

std::string member(const std::string& place, std::string_view name) {
    return place + (place.empty() ? "" : ".") + key(std::string(name));
}

const OrderedJson& need_list(const OrderedJson& value, const std::string& place) {
    if (!value.is_array()) fail(place, "it must be a list, not " + shown(value));
    return value;
}

Fields::Fields(const OrderedJson& object, std::string place, Notation notation)
    : object_(object), place_(std::move(place)), notation_(notation) {
    if (!object.is_object()) fail(place_, "it must be an object, not " + shown(object));
    is_read_.resize(object.size());
    std::unordered_set<std::string_view> keys;
    for (const auto& [name, value] : object.items()) {
        if (!keys.insert(name).second) fail(member(place_, name), "it stands twice");
    }
}

std::string Fields::place_of(std::string_view key) const {
    return member(place_, spelled(key, notation_));
}

const OrderedJson* Fields::find(std::string_view key) {
    if (asked_.empty() || asked_.back() != key) asked_.push_back(key);
    const std::string name = spelled(key, notation_);
    std::size_t number = 0;
    for (auto member = object_.begin(); member != object_.end(); ++member, ++number) {
        if (member.key() != name) continue;
        is_read_[number] = true;
        return &*member;
    }
    return nullptr;
}

const OrderedJson& Fields::need(std::string_view key) {
    const OrderedJson* value = find(key);
    if (value == nullptr) fail(place_of(key), "it is required and missing");
    return *value;
}

void Fields::refuse_others() const {
    std::size_t number = 0;
    for (auto member = object_.begin(); member != object_.end(); ++member, ++number) {
        if (is_read_[number]) continue;
        std::string known;
        for (const std::string_view key : asked_) known += (known.empty() ? "" : ", ") + spelled(key, notation_);
        fail(bendy::converter::member(place_, member.key()), "there is no such key; there are " + known);
    }
}

void Fields::read(std::string_view key, std::string& text) {
    const OrderedJson* value = find(key);
    if (value == nullptr) return;
    if (!value->is_string()) fail(place_of(key), "it must be a string, not " + shown(*value));
    text = value->text();
}

void Fields::read(std::string_view key, bool& value) {
    const OrderedJson* found = find(key);
    if (found == nullptr) return;
    const double number = found->is_number()                          ? found->get<double>()
                          : found->is_boolean() && found->get<bool>() ? 1.0
                                                                      : 0.0;
    const bool is_good = found->is_boolean() || (found->is_number() && (number == 0.0 || number == 1.0));
    if (!is_good) fail(place_of(key), "it must be true or false, not " + shown(*found));
    value = number != 0.0;
}

void Fields::read(std::string_view key, float& number, float low, float high) {
    const OrderedJson* value = find(key);
    if (value == nullptr) return;
    number = to_float(*value, place_of(key));
    check_between(number, low, high, place_of(key));
}

void Fields::read(std::string_view key, std::span<float> numbers, float low, float high) {
    const OrderedJson* value = find(key);
    if (value == nullptr) return;
    const std::string place = place_of(key);
    need_list_of(numbers.size(), *value, place);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        numbers[i] = to_float((*value)[i], at(place, i));
        check_between(numbers[i], low, high, at(place, i));
    }
}

void Fields::read_angle(std::string_view key, float& angle) {
    if (const OrderedJson* value = find(key); value != nullptr) angle = to_float(*value, place_of(key), notation_);
}

void Fields::read_angles(std::string_view key, std::span<float> angles) {
    const OrderedJson* value = find(key);
    if (value == nullptr) return;
    const std::string place = place_of(key);
    need_list_of(angles.size(), *value, place);
    for (std::size_t i = 0; i < angles.size(); ++i) angles[i] = to_float((*value)[i], at(place, i), notation_);
}

void Fields::read_range(std::string_view key, float& low, float& high) {
    if (const OrderedJson* value = find(key); value != nullptr)
        read_pair(*value, place_of(key), Notation::extras, low, high);
}

void Fields::read_angle_range(std::string_view key, float& low, float& high) {
    if (const OrderedJson* value = find(key); value != nullptr) read_pair(*value, place_of(key), notation_, low, high);
}

void Fields::read_rotation(std::string_view key, std::array<float, 4>& rotation) {
    if (find(key) == nullptr) return;
    read(key, rotation);
    if (is_unit(rotation, kUnitTolerance)) return;
    double square = 0.0;
    for (const float component : rotation) square += static_cast<double>(component) * static_cast<double>(component);
    if (square == 0.0) fail(place_of(key), "0 0 0 0 is not a rotation");
    for (float& component : rotation) component = static_cast<float>(component / std::sqrt(square));
}

void Fields::read_integer(std::string_view key, std::uint64_t most, std::uint64_t& number) {
    const OrderedJson* value = find(key);
    if (value == nullptr) return;
    const bool is_whole = value->is_number() && value->get<double>() == std::floor(value->get<double>());
    if (!is_whole) fail(place_of(key), "it must be a whole number, not " + shown(*value));
    const auto wanted = value->get<double>();
    if (!(wanted >= 0.0 && wanted <= static_cast<double>(most)))
        fail(place_of(key), shown(*value) + " is not between 0 and " + std::to_string(most));
    number = static_cast<std::uint64_t>(wanted);
}

void Fields::read_word(std::string_view key, std::span<const std::string_view> words, std::uint8_t& number) {
    const OrderedJson* value = find(key);
    if (value == nullptr) return;
    if (value->is_string()) {
        const auto word = std::find_if(words.begin(), words.end(), [&](std::string_view each) {
            return spelled(each, notation_) == value->text();
        });
        if (word != words.end()) {
            number = static_cast<std::uint8_t>(word - words.begin());
            return;
        }
    }
    std::string known;
    for (const std::string_view word : words) known += (known.empty() ? "" : ", ") + spelled(word, notation_);
    fail(place_of(key), shown(*value) + " is none of " + known);
}

}  // namespace bendy::converter
