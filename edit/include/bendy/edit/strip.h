#pragma once

#include <bendy/edit/outcome.h>
#include <bendy/format/byte_reader.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace bendy::edit {

/// What can be taken out of a file.
enum class Part : std::uint8_t {
    textures,     ///< TEXT; materials do without
    materials,    ///< MATE, local ones too; polygons have none
    meshes,       ///< VECT, with polygons, weights tracks and levels of detail
    targets,      ///< TARG, with their weights in clips
    clips,        ///< CYCL
    markers,      ///< MARK
    chains,       ///< IKCH and PULL
    constraints,  ///< LIMT; by name: of a joint
    lod,          ///< LODD
    tangents,     ///< TANG, of targets too
    colours,      ///< COLR
    attributes,   ///< USER
    extras,       ///< EXTR and MORE
    extensions,   ///< EXTN
    unknown       ///< chunks that this version has no page for; by name: with this id
};

struct Strip {
    Part part = Part::textures;
    std::string name;  ///< see find_named; empty: all of them
};

/// "clips", "clip:Run", "mesh:Hat*": the part's name in one of its two numbers, and which of them. A part that stands
/// alone (markers, lod, tangents, colours, attributes, extras, extensions) takes no name.
Result<Strip, Problem> parse_strip(std::string_view text);
/// The words that parse_strip takes, for help and errors: "textures, materials, ...".
std::string strip_words();

/// The file without a part of it. What referred to it refers to nothing, or goes too; what is numbered is numbered
/// anew. An image that a texture which stays shares with one that goes moves to the former. A name that nothing has is
/// a problem; a part that is not there is none.
Edited strip(Bytes file, const Strip& what, Log& log);

}  // namespace bendy::edit
