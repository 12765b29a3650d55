#pragma once

#include <bendy/edit/outcome.h>
#include <bendy/format/byte_reader.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace bendy::edit {

/// What can be removed from a file.
enum class Part : std::uint8_t {
    textures,     ///< TEXT; materials are left without them
    materials,    ///< MATE, including local ones; submeshes are left without them
    meshes,       ///< VECT, with submeshes, weights tracks and levels of detail
    targets,      ///< TARG, with their weights in clips
    clips,        ///< CYCL
    markers,      ///< MARK
    chains,       ///< IKCH and PULL
    constraints,  ///< LIMT; by name: the name of a joint
    lod,          ///< LODD
    tangents,     ///< TANG, also of morph targets
    colours,      ///< COLR
    attributes,   ///< USER
    extras,       ///< EXTR and MORE
    extensions,   ///< EXTN
    unknown       ///< chunks unknown to this version; by name: with this id
};

struct Strip {
    Part part = Part::textures;
    std::string name;  ///< see find_named; empty: all of them
};

/// Parses "clips", "clip:Run", "mesh:Hat*": the name of a part in singular or plural, optionally followed by which
/// ones. Parts that cannot be selected by name (markers, lod, tangents, colours, attributes, extras, extensions) take
/// none.
Result<Strip, Problem> parse_strip(std::string_view text);
/// Returns the words that parse_strip accepts, for help and error messages: "textures, materials, ...".
std::string strip_words();

/// Returns the file without the given part. References to it are cleared, or what refers to it is removed too; things
/// that are numbered are renumbered. An image shared by a removed and a remaining texture moves to the remaining one. A
/// name that matches nothing is a problem; a part that the file does not contain is not.
Edited strip(Bytes file, const Strip& what, Log& log);

}  // namespace bendy::edit
