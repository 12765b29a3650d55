#pragma once

#include <bendy/format/public.h>

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

// What to say of names that a user got wrong.
namespace BENDY_PUBLIC bendy {

/// The name that is most like `wanted`; empty if none is like it at all.
std::string_view nearest_name(std::span<const std::string_view> names, std::string_view wanted);

/// `; did you mean "Walk"?`, if a name is like `wanted`; else nothing.
std::string did_you_mean(std::span<const std::string_view> names, std::string_view wanted);

/// What to say where `wanted` is none of the names: `there is no clip "Wlak"; did you mean "Walk"?`, and which names
/// there are where they are few, or none is like it. Names are as they are in the file: not fit for a terminal.
std::string no_such_name(std::string_view kind, std::string_view wanted, std::span<const std::string_view> names);

/// `"a", "b", "c" and 3 more`; a thing without a name is its number, `#3`.
std::string list_names(std::span<const std::string_view> names, std::span<const std::size_t> numbers,
                       std::size_t most = 8);

}  // namespace bendy
