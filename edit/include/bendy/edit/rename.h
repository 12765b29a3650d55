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

/// What has a name.
enum class Named : std::uint8_t { joint, clip, chain, mesh, target, material, texture, object };

/// Names of one kind: each name that a pair's first matches becomes its second. The first pair that matches counts, and
/// all are looked up in the names as the file has them, so two names can be swapped. A `*` in the first (one at most)
/// stands for any bytes, and for the same bytes in the second: {"mixamorig:*", "*"} takes a prefix away. "#3" is the
/// thing with that number, with or without a name.
struct Rename {
    Named kind = Named::joint;
    std::vector<std::pair<std::string, std::string>> names;
    bool all_must_match = true;  ///< a pair that matches nothing is a problem; else a warning
};

/// "OLD=NEW" as a pair. The first `=` parts them.
Result<std::pair<std::string, std::string>, Problem> parse_pair(std::string_view text);
/// "joint", "clip", ...
Result<Named, Problem> parse_named(std::string_view word);

/// The file with other names, in NAME chunks or JNAM. A name that would become empty is a problem; two things of one
/// kind that come to have one name are a warning.
Edited rename(Bytes file, const Rename& what, Log& log);

}  // namespace bendy::edit
