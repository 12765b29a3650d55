#pragma once

#include <bendy/edit/outcome.h>
#include <bendy/format/byte_reader.h>

#include <cstdint>

namespace bendy::edit {

/// What becomes of a clip whose name is taken.
enum class SameName : std::uint8_t {
    refuse,   ///< a problem
    replace,  ///< it takes the place, and the number, of the one that is there
    number    ///< it gets a name of its own: "Run.001"
};

/// The file with the clips of another one's first object behind those of its own first object. Tracks go to the joint
/// of the same name (of several, to the one below the same parent; those without a name in turn below theirs), weights
/// tracks to the mesh of the same name and there to the target of the same name; tracks that find none are left out and
/// listed. Keys stay as they are, packed samples too; only the packed tracks of a joint whose rest transform is another
/// one here are decoded, since they are relative to it. Rest poses that differ are warned about. A file of which
/// nothing fits is a problem.
Edited merge_clips(Bytes file, Bytes other, SameName same_name, Log& log);

}  // namespace bendy::edit
