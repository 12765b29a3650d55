#pragma once

#include <bendy/edit/outcome.h>
#include <bendy/format/byte_reader.h>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace bendy::edit {

/// Kinds of things that have names.
enum class Named : std::uint8_t { joint, clip, chain, mesh, target, material, texture, object };

/// Renames things of one kind: a name that matches the first of a pair becomes the second. The first matching pair
/// applies, and all pairs are matched against the names in the file, so two names can be swapped. A `*` in the first
/// (at most one) stands for any bytes, and for the same bytes in the second: {"mixamorig:*", "*"} removes a prefix.
/// "#3" is the thing with that number, whether or not it has a name.
struct Rename {
    Named kind = Named::joint;
    std::vector<std::pair<std::string, std::string>> names;
    bool all_must_match = true;  ///< if false, a pair without a match is a warning instead of a problem
};

/// Parses "OLD=NEW", split at the first `=`.
Result<std::pair<std::string, std::string>, Problem> parse_pair(std::string_view text);
/// Parses "joint", "clip", ...
Result<Named, Problem> parse_named(std::string_view word);

/// Returns the file with names changed, in NAME chunks or JNAM. A name that would become empty is a problem; two things
/// of one kind that end up with the same name cause a warning.
Edited rename(Bytes file, const Rename& what, Log& log);

}  // namespace bendy::edit
