#pragma once

#include <cassert>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::text_form {

enum class ValueKind : std::uint8_t { null, boolean, number, string, array, object };

/// The JSON of one chunk, stored flat: one word per number, so that a million of them take eight megabytes. A value is
/// identified by the index of its first word.
///
///     null, boolean, number   [kind, offset in the text]
///     string                  [kind, offset] [index among the characters] [length]
///     array                   [kind, offset] [index after its last word] values
///     object                  [kind, offset] [index after its last word] strings and values in turn
class LeafValues {
public:
    void clear() {
        words_.clear();
        open_.clear();
        characters_.clear();
    }

    // Called by a parser; `offset` is the token's position in the text.
    std::uint64_t add(ValueKind kind, std::uint64_t offset) {
        words_.push_back(static_cast<std::uint64_t>(kind) << kKindShift | offset);
        return words_.size() - 1;
    }
    std::uint64_t add_string(std::uint64_t offset, std::string_view characters) {
        const std::uint64_t value = add(ValueKind::string, offset);
        words_.push_back(characters_.size());
        words_.push_back(characters.size());
        characters_ += characters;
        return value;
    }
    std::uint64_t begin(ValueKind kind, std::uint64_t offset) {
        const std::uint64_t value = add(kind, offset);
        words_.push_back(0);
        open_.push_back(value);
        return value;
    }
    void end() {
        assert(!open_.empty());
        words_[open_.back() + 1] = words_.size();
        open_.pop_back();
    }
    /// Number of open arrays and objects.
    [[nodiscard]] std::size_t depth() const { return open_.size(); }
    /// The innermost open array or object.
    [[nodiscard]] std::uint64_t innermost() const { return open_.back(); }

    [[nodiscard]] ValueKind kind(std::uint64_t value) const {
        return static_cast<ValueKind>(words_[value] >> kKindShift);
    }
    /// Offset in the text in bytes.
    [[nodiscard]] std::uint64_t offset(std::uint64_t value) const { return words_[value] & kOffsetMask; }
    [[nodiscard]] std::string_view characters(std::uint64_t string) const {
        return std::string_view(characters_).substr(words_[string + 1], words_[string + 2]);
    }
    /// The value after this one.
    [[nodiscard]] std::uint64_t next(std::uint64_t value) const {
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
    /// The first value, or key, of an array or object; they end at `next` of the array or object.
    [[nodiscard]] static std::uint64_t first(std::uint64_t parent) { return parent + 2; }

private:
    static constexpr unsigned kKindShift = 60;
    static constexpr std::uint64_t kOffsetMask = (std::uint64_t{1} << kKindShift) - 1;

    std::vector<std::uint64_t> words_;
    std::vector<std::uint64_t> open_;
    std::string characters_;
};

}  // namespace bendy::text_form
