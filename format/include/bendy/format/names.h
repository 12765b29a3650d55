#pragma once

#include <bendy/format/public.h>
#include <bendy/format/result.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// How a user's text refers to a named and numbered thing, and messages about mistyped names.
namespace BENDY_PUBLIC bendy {

/// The thing that a text refers to. "#3" is the number 3, "=3" the name "3", "3" either of them; any other text is a
/// name.
struct ThingKey {
    std::optional<std::string_view> name;  ///< a part of the text
    std::optional<std::size_t> number;
};
ThingKey read_key(std::string_view text);

/// A text that refers to nothing, or to two different things.
struct KeyProblem {
    std::string message;  ///< names are as in the file: escape them for a terminal
    bool is_ambiguous = false;
};

/// Returns the numbers of all things that a text refers to: those with the name, in order, or the one with the number.
/// `kind` is the singular of what is named, as in "clip".
Result<std::vector<std::size_t>, KeyProblem> find_all_by_key(std::span<const std::string_view> names,
                                                             std::string_view text, std::string_view kind);
/// Returns the first of them. Whether a text is ambiguous depends on the first of each name alone.
Result<std::size_t, KeyProblem> find_by_key(std::span<const std::string_view> names, std::string_view text,
                                            std::string_view kind);

/// Returns the name most similar to `wanted`; empty if none is similar.
std::string_view nearest_name(std::span<const std::string_view> names, std::string_view wanted);

/// Returns `; did you mean "Walk"?` if some name is similar to `wanted`; otherwise nothing.
std::string did_you_mean(std::span<const std::string_view> names, std::string_view wanted);

/// Returns a message for a name that does not exist, with a similar name, `...; did you mean "Walk"?`, and a list of
/// the existing names if these are few, or if none is similar. Names are as in the file: escape them for a terminal.
std::string no_such_name(std::string_view kind, std::string_view wanted, std::span<const std::string_view> names);

/// Returns `"Walk"`.
std::string in_quotes(std::string_view name);

/// Returns "3 joints", "1 joint".
/// \param many  the plural; empty: `one` and an s
std::string counted(std::uint64_t count, std::string_view one, std::string_view many = {});

/// Returns `"a", "b", "c" and 3 more`; a thing without a name is listed by its number, `#3`.
std::string list_names(std::span<const std::string_view> names, std::span<const std::size_t> numbers,
                       std::size_t most = 8);

}  // namespace bendy
