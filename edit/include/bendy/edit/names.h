#pragma once

#include <bendy/edit/outcome.h>
#include <bendy/format/names.h>

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

// Finds things by the names that users give.
namespace bendy::edit {

/// Returns true if all of `name` matches `pattern`; `*` stands for any bytes, `?` for one byte.
bool matches(std::string_view pattern, std::string_view name);

/// Returns the numbers of all things that `wanted` refers to: those with exactly this name; otherwise the one with this
/// number ("#3"); otherwise, if it contains `*` or `?`, those that match it. If there are none, returns a problem that
/// lists or suggests names. `kind` is the singular of what is named, as in "clip".
Result<std::vector<std::size_t>, Problem> find_named(std::span<const std::string_view> names, std::string_view wanted,
                                                     std::string_view kind);

}  // namespace bendy::edit
