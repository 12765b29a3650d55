#pragma once

#include "attach_rig.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

namespace bendy::converter {

/// Gives a scene the constraints and chains that its extras speak of: rig_joint and rig_ik of nodes, rig_ik of the
/// scene (spec/rig.md), but for what is claimed already, and claims them. The extras stay as they are. What is wrong in
/// them is named in `report` and left out.
void attach_extras(Scene& scene, const JointIndex& index, Claims& claims, Report& report);

}  // namespace bendy::converter
