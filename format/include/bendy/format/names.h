#pragma once

#include <bendy/format/public.h>

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

// Messages about names that a user mistyped.
namespace BENDY_PUBLIC bendy {

/// Returns the name most similar to `wanted`; empty if none is similar.
std::string_view nearest_name(std::span<const std::string_view> names, std::string_view wanted);

/// Returns `; did you mean "Walk"?` if some name is similar to `wanted`; otherwise nothing.
std::string did_you_mean(std::span<const std::string_view> names, std::string_view wanted);

/// Returns a message for a name that does not exist: `there is no clip "Wlak"; did you mean "Walk"?`, with a list of
/// the existing names if these are few, or if none is similar. Names are as in the file: escape them for a terminal.
std::string no_such_name(std::string_view kind, std::string_view wanted, std::span<const std::string_view> names);

/// Returns `"a", "b", "c" and 3 more`; a thing without a name is listed by its number, `#3`.
std::string list_names(std::span<const std::string_view> names, std::span<const std::size_t> numbers,
                       std::size_t most = 8);

}  // namespace bendy
