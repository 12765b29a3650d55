#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/format/names.h>
#include <bendy/format/packed_clip.h>
#include <bendy/format/records.h>
#include <bendy/format/result.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// Changes to a bendy file that need no new conversion. Every operation takes the bytes of a whole file, starting on a
// 16-byte boundary, checks all of them, and returns the bytes of another file, which has passed bendy::validate. Chunks
// that are not affected keep their bytes, even if encoded; unknown chunks are kept in the same parent and position. A
// file with an unknown chunk that is REQUIRED is refused. The same input gives the same bytes.
namespace bendy::edit {

/// The reason for a missing result, as a sentence for the user; names in it are as in the file, not escaped.
struct Problem {
    std::string message;
};

/// The report of an operation: what it has done, and what the user should check. Not escaped.
struct Log {
    std::vector<std::string> done;
    std::vector<std::string> warnings;
};

using Edited = Result<std::vector<std::byte>, Problem>;

/// Returns true if all of `name` matches `pattern`; `*` stands for any bytes, `?` for one byte.
bool matches(std::string_view pattern, std::string_view name);

/// Returns the numbers of all things that `wanted` refers to: see find_all_by_key. If there are none and `wanted`
/// contains `*` or `?` but does not start with `=`, returns those whose names match it. If there are none either,
/// returns a problem that lists or suggests names.
Result<std::vector<std::size_t>, Problem> find_named(std::span<const std::string_view> names, std::string_view wanted,
                                                     std::string_view kind);

/// The parts that can be removed from a file.
enum class Part : std::uint8_t {
    textures,       ///< TEXT; materials are left without them
    materials,      ///< MATE, including local ones; submeshes are left without them
    meshes,         ///< VECT, with submeshes, weights tracks and levels of detail
    targets,        ///< TARG, with their weights in clips
    clips,          ///< CYCL
    markers,        ///< MARK
    chains,         ///< IKCH and PULL
    roles,          ///< ROLE
    standing_pose,  ///< STND
    constraints,    ///< LIMT; by name: the name of a joint
    lod,            ///< LODD
    tangents,       ///< TANG, also of morph targets
    colours,        ///< COLR
    attributes,     ///< USER
    extras,         ///< EXTR and MORE
    extensions,     ///< EXTN
    unknown         ///< chunks unknown to this version; by name: with this id
};

struct Strip {
    Part part = Part::textures;
    std::string name;  ///< see find_named; empty: all of them
};

/// Parses "clips", "clip:Run", "mesh:Hat*": the name of a part in singular or plural, optionally followed by which
/// ones. Parts that cannot be selected by name (markers, roles, lod, tangents, colours, attributes, extras, extensions)
/// take none.
Result<Strip, Problem> parse_strip(std::string_view text);
/// Returns the words that parse_strip accepts, for help and error messages: "textures, materials, ...".
std::string strip_words();

/// Returns the file without the given part. References to it are cleared, or what refers to it is removed too; things
/// that are numbered are renumbered. An image shared by a removed and a remaining texture moves to the remaining one. A
/// name that matches nothing is a problem; a part that the file does not contain is not.
Edited strip(Bytes file, const Strip& what, Log& log);

/// Kinds of things that have names.
enum class Named : std::uint8_t { joint, clip, chain, mesh, target, material, texture, object };

/// Renames things of one kind: a name that matches the first of a pair becomes the second. The first matching pair
/// applies, and all pairs are matched against the names in the file, so two names can be swapped. A `*` in the first
/// (at most one) stands for any bytes, and for the same bytes in the second: {"mixamorig:*", "*"} removes a prefix.
/// Numbers and exact names are written as for find_all_by_key: "#3", "=3".
struct Rename {
    Named kind = Named::joint;
    std::vector<std::pair<std::string, std::string>> names;
    bool all_must_match = true;  ///< if false, a pair without a match is a warning instead of a problem
};

/// Returns the name with a pair of Rename::names applied; nothing if it does not match.
std::optional<std::string> renamed(const std::pair<std::string, std::string>& pair, std::string_view name);

/// Parses "OLD=NEW", split at the first `=` that follows a name: "=0=Run" renames what is called "0".
Result<std::pair<std::string, std::string>, Problem> parse_pair(std::string_view text);
/// Parses "joint", "clip", ...
Result<Named, Problem> parse_named(std::string_view word);

/// Returns the file with names changed, in NAME chunks or JNAM. A name that would become empty is a problem; two things
/// of one kind that end up with the same name cause a warning.
Edited rename(Bytes file, const Rename& what, Log& log);

/// What a joint of the first object is in the body.
struct SetRole {
    Role role = Role::hips;
    std::uint16_t place = 0;  ///< in a chain
    std::string joint;        ///< see find_named; empty: nobody has the role
};

/// Parses "hips=Pelvis", "tail:2=Tail3", and "jaw=": nobody has the role.
Result<SetRole, Problem> parse_role(std::string_view text);

/// Returns the file in which the first object's body stands like this.
Edited set_standing_pose(Bytes file, const StandingPoseRecord& pose, std::span<const StandingRotationRecord> rotations);

/// Returns the file in which the joint has the role, and nobody else; the role that it had before is free.
Edited set_role(Bytes file, const SetRole& what, Log& log);

/// A new value for a field of a material.
struct SetMaterial {
    std::string material;  ///< see find_named: all that it refers to are changed
    std::string field;     ///< of SurfaceRecord in records.h, as in "roughness" or "normal_texture.scale"
    /// Numbers with commas between them; the word of an enumeration's value; for a texture its name or number, or
    /// "none".
    std::string value;
};

/// Parses "material:Wood.roughness=0.4". A text without a field of a material is a problem that lists the fields.
Result<SetMaterial, Problem> parse_set(std::string_view text);

/// Returns the file in which the materials have this value. A value outside the field's range is a problem.
Edited set_material(Bytes file, const SetMaterial& what, Log& log);

/// How to handle a clip whose name is already taken.
enum class SameName : std::uint8_t {
    error,    ///< reported as a problem
    replace,  ///< replaces the existing clip, and takes its number
    number    ///< is given a new name: "Run.001"
};

/// Appends the clips of another file's first object to those of this file's first object. A track is assigned to the
/// joint of the same name (if there are several, to the one with the same parent; unnamed joints are matched in order
/// below theirs), a weights track to the mesh of the same name and there to the morph targets of the same name. Tracks
/// without a match are left out and listed. Keys are copied unchanged, packed samples too; only the packed tracks of a
/// joint whose rest transform differs here are decoded, since they are relative to it. Differing rest poses cause a
/// warning. If nothing in the other file matches, that is a problem.
Edited add_clips(Bytes file, Bytes other, SameName same_name, Log& log);
/// Parses "error", "replace" or "number".
Result<SameName, Problem> parse_same_name(std::string_view word);

/// Clips of another file's first object that has clips, as they come into this file's first object: some of their
/// tracks as they are, others made for this file. For bendy::motion, which retargets clips.
struct Transfer {
    struct Weights {
        std::uint32_t mesh = kNone;       ///< here; kNone: the mesh's weights tracks are left out
        std::vector<std::uint32_t> from;  ///< for each morph target of that mesh, the one there; kNone: none
    };
    struct Clip {
        std::size_t number = 0;                      ///< there
        std::vector<bool> kept;                      ///< by joint there: its tracks go to the joint here as they are
        std::vector<UnpackedTrack> tracks;           ///< added; `joint` is a joint here, for weights a mesh here
        std::vector<std::vector<std::byte>> curves;  ///< added: payloads of CURV
        std::string report;                          ///< for Log::done, after the clip's name
    };
    std::vector<std::uint32_t> joints;  ///< for each joint there, the one here; kNone: none
    std::vector<Weights> weights;       ///< for each mesh there
    std::vector<Clip> clips;
};

/// Appends these clips to those of this file. Their markers and all else that they have come along; curves and frames
/// are assigned as by add_clips, those of joints by Transfer::joints.
Edited put_clips(Bytes file, Bytes other, const Transfer& transfer, SameName same_name, Log& log);

/// Extracts a part of a character into a file of its own: the joint with this name (see find_named) and its
/// descendants, their submeshes, the vertices that those use, their meshes' morph targets, the materials and textures
/// still in use, the chains whose links are all inside, the constraints, and the clips' tracks.
///
/// Every remaining vertex stays exactly where it was, to the last bit, in every clip. For that, the ancestors of the
/// joint and other joints that influence a remaining vertex are kept too, without submeshes of their own. The log lists
/// these and everything that is removed.
Edited extract(Bytes file, std::string_view joint, Log& log);

}  // namespace bendy::edit
