#pragma once

#include <bendy/edit/edit.h>
#include <bendy/format/byte_reader.h>
#include <bendy/runtime/model.h>

#include <string>

// The pose in which a character's body stands (Model::standing_pose), told by a person.
namespace bendy::motion {

/// Returns the file in which the body stands as at a time of a clip, in seconds, with Y up, turned about Y so that it
/// faces +Z if it is more than 20 degrees off: where it looks in one frame must not turn all clips. A problem: no such
/// clip, no joint with a role, or a body of which left or right is not known.
/// \param clip  see edit::find_named
edit::Edited stand_as_in_clip(Bytes file, const std::string& clip, double seconds, edit::Log& log);

/// Returns the file in which the body stands as another file's character rests, joints by their names. A problem also:
/// a joint with a role that the other file does not have.
edit::Edited stand_as(Bytes file, Bytes other, edit::Log& log);

/// Returns by how many radians about Y a character is turned that stands with Y up, as its roles say: 0 if it faces +Z,
/// up to 20 degrees, or if left is not known.
double facing(const Model& model);

}  // namespace bendy::motion
