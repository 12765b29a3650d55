#pragma once

#include <bendy/edit/outcome.h>
#include <bendy/format/byte_reader.h>

#include <string_view>

namespace bendy::edit {

/// Extracts a part of a character into a file of its own: the joint with this name (see find_named) and its
/// descendants, their submeshes, the vertices that those use, their meshes' morph targets, the materials and textures
/// still in use, the chains whose links are all inside, the constraints, and the clips' tracks.
///
/// Every remaining vertex stays exactly where it was, to the last bit, in every clip. For that, the ancestors of the
/// joint and other joints that influence a remaining vertex are kept too, without submeshes of their own. The log lists
/// these and everything that is removed.
Edited extract(Bytes file, std::string_view joint, Log& log);

}  // namespace bendy::edit
