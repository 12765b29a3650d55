#pragma once

#include <bendy/edit/outcome.h>
#include <bendy/format/byte_reader.h>

#include <string_view>

namespace bendy::edit {

/// A part of a character as a file of its own: the joint with this name (see find_named) and all below it, with the
/// polygons that belong to these joints, the vertices that those use, their meshes' targets, the materials and textures
/// that are left in use, the chains whose links are all inside, the limits, and the clips' tracks.
///
/// Everything stays where it was, to the last bit, in every clip: so the joints above, and those outside that also
/// pull at a vertex which stays, stay too, without polygons of their own. They and all that falls away are in the log.
Edited extract(Bytes file, std::string_view joint, Log& log);

}  // namespace bendy::edit
