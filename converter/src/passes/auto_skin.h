#pragma once

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>
#include <bendy/format/result.h>

#include <string>

namespace bendy::converter {

/// Rigid skinning by distance (Hagland's technique): in the rest pose, with the targets' rest weights, every vertex is
/// bound with weight 1 to the joint whose bone is nearest; of bones equally near, to the lower joint. The rest pose
/// stays as it looks.
///
/// A joint's bones are the lines to its children in the skeleton; the bone of one without children goes on from its
/// parent's, half as long. The skeleton is `skeleton` with all joints below it; or, where that is empty, the joints of
/// the file's skins; or, where there is none, every joint that carries no mesh and has none below it. Only meshes
/// without a skin are bound, and of these only such as do not hang on a joint of the skeleton, which moves them
/// already.
///
/// \param skeleton  a joint's name, or `#` and its number; may be empty
/// Notes in `report` how many vertices of each mesh went to how many joints; with nothing to bind it warns. An error:
/// no such joint, or more vertices times bones than 2^33, some tens of seconds of work.
Result<void, ImportError> auto_skin(Scene& scene, const std::string& skeleton, Report& report);

}  // namespace bendy::converter
