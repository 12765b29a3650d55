#pragma once

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>
#include <bendy/format/result.h>

#include <string>

namespace bendy::converter {

/// Rigid skinning by distance (Hagland's technique): in the rest pose, with the targets' rest weights, every vertex is
/// bound with weight 1 to the joint with the nearest bone; on a tie, to the lower joint. The rest pose looks the same
/// afterwards.
///
/// A joint's bones are the lines to its children in the skeleton; a joint without children continues its parent's bone
/// at half the length. The skeleton is `skeleton` with all its descendants; if that is empty, the joints of the file's
/// skins; if there are none, every joint without a mesh on it or on a descendant; if there are none of these either, a
/// hierarchy of part meshes that the other meshes enclose (the paper's [5]), which is said. Only meshes without a skin
/// are bound, and of these only the ones that no joint of the skeleton already carries.
///
/// \param skeleton  a joint's name, or `#` and its number; may be empty
/// Notes in `report` how many vertices of each mesh went to how many joints; warns if there is nothing to bind. Errors:
/// the joint does not exist, or vertices times bones exceed 2^33, some tens of seconds of work.
Result<void, ImportError> auto_skin(Scene& scene, const std::string& skeleton, Report& report);

}  // namespace bendy::converter
