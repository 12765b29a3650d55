#include "leaf_value.h"

#include <cassert>

namespace bendy::text_form {
namespace {

constexpr unsigned kKindShift = 60;
constexpr std::uint64_t kOffsetMask = (std::uint64_t{1} << kKindShift) - 1;

}  // namespace

void LeafValues::clear() {
    words_.clear();
    open_.clear();
    characters_.clear();
}

std::uint64_t LeafValues::add(ValueKind kind, std::uint64_t offset) {
    words_.push_back(static_cast<std::uint64_t>(kind) << kKindShift | offset);
    return words_.size() - 1;
}

std::uint64_t LeafValues::add_string(std::uint64_t offset, std::string_view characters) {
    const std::uint64_t value = add(ValueKind::string, offset);
    words_.push_back(characters_.size());
    words_.push_back(characters.size());
    characters_ += characters;
    return value;
}

std::uint64_t LeafValues::begin(ValueKind kind, std::uint64_t offset) {
    const std::uint64_t value = add(kind, offset);
    words_.push_back(0);
    open_.push_back(value);
    return value;
}

void LeafValues::end() {
    assert(!open_.empty());
    words_[open_.back() + 1] = words_.size();
    open_.pop_back();
}

ValueKind LeafValues::kind(std::uint64_t value) const {
    return static_cast<ValueKind>(words_[value] >> kKindShift);
}

std::uint64_t LeafValues::offset(std::uint64_t value) const {
    return words_[value] & kOffsetMask;
}

std::string_view LeafValues::characters(std::uint64_t string) const {
    return std::string_view(characters_).substr(words_[string + 1], words_[string + 2]);
}

std::uint64_t LeafValues::next(std::uint64_t value) const {
    switch (kind(value)) {
        case ValueKind::string:
            return value + 3;
        case ValueKind::array:
        case ValueKind::object:
            return words_[value + 1];
        default:
            return value + 1;
    }
}

}  // namespace bendy::text_form
