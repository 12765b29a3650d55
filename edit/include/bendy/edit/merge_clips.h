#pragma once

#include <bendy/edit/outcome.h>
#include <bendy/format/byte_reader.h>

#include <cstdint>

namespace bendy::edit {

/// What happens to a clip whose name is already taken.
enum class SameName : std::uint8_t {
    refuse,   ///< reported as a problem
    replace,  ///< replaces the existing clip, and takes its number
    number    ///< is given a new name: "Run.001"
};

/// Appends the clips of another file's first object to those of this file's first object. A track is assigned to the
/// joint of the same name (if there are several, to the one with the same parent; unnamed joints are matched in order
/// below theirs), a weights track to the mesh of the same name and there to the morph targets of the same name. Tracks
/// without a match are left out and listed. Keys are copied unchanged, packed samples too; only the packed tracks of a
/// joint whose rest transform differs here are decoded, since they are relative to it. Differing rest poses cause a
/// warning. If nothing in the other file matches, that is a problem.
Edited merge_clips(Bytes file, Bytes other, SameName same_name, Log& log);

}  // namespace bendy::edit
