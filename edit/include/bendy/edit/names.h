#pragma once

#include <bendy/edit/outcome.h>
#include <bendy/format/names.h>

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

// Finding things by what a user calls them.
namespace bendy::edit {

/// True if the whole of `name` is as `pattern` has it; `*` stands for any bytes, `?` for one.
bool matches(std::string_view pattern, std::string_view name);

/// The numbers of all things that `wanted` means: those with exactly this name; else the one with this number ("#3");
/// else, if it has a `*` or `?`, those that match. If there are none: a problem that lists or suggests names. `kind` is
/// one of them, as in "clip".
Result<std::vector<std::size_t>, Problem> find_named(std::span<const std::string_view> names, std::string_view wanted,
                                                     std::string_view kind);

}  // namespace bendy::edit
