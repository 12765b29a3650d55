#pragma once

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
    void clear();

    // Called by a parser; `offset` is the token's position in the text.
    std::uint64_t add(ValueKind kind, std::uint64_t offset);
    std::uint64_t add_string(std::uint64_t offset, std::string_view characters);
    std::uint64_t begin(ValueKind kind, std::uint64_t offset);
    void end();
    /// Number of open arrays and objects.
    [[nodiscard]] std::size_t depth() const { return open_.size(); }
    /// The innermost open array or object.
    [[nodiscard]] std::uint64_t innermost() const { return open_.back(); }

    [[nodiscard]] ValueKind kind(std::uint64_t value) const;
    /// Offset in the text in bytes.
    [[nodiscard]] std::uint64_t offset(std::uint64_t value) const;
    [[nodiscard]] std::string_view characters(std::uint64_t string) const;
    /// The value after this one.
    [[nodiscard]] std::uint64_t next(std::uint64_t value) const;
    /// The first value, or key, of an array or object; they end at `next` of the array or object.
    [[nodiscard]] static std::uint64_t first(std::uint64_t parent) { return parent + 2; }

private:
    std::vector<std::uint64_t> words_;
    std::vector<std::uint64_t> open_;
    std::string characters_;
};

}  // namespace bendy::text_form
