#pragma once

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

namespace bendy::converter {

/// Proposes IK chains and anatomical limits for a character whose joints have names of a human's, or a VRM humanoid:
/// for joints without limits, and chains whose names are not taken. All is flagged kProposed and listed in `report`. Of
/// a four-legged animal with such names, only the chains.
void auto_rig(Scene& scene, Report& report);

}  // namespace bendy::converter
