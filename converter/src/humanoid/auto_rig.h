#pragma once

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <vector>

namespace bendy::converter {

/// Proposes IK chains and anatomical limits for a character whose joints have names of a human's, or a VRM humanoid:
/// for joints without limits that are not `claimed`, and chains whose names are not taken. All is flagged kProposed and
/// listed in `report`. Of a four-legged animal with such names, only the chains.
/// \param claimed  by joint: somebody has said that it has no limits; empty: nobody has
void auto_rig(Scene& scene, const std::vector<bool>& claimed, Report& report);

/// Adds a VRM humanoid's chains (see make_limb_chains) whose names are not taken.
void add_vrm_chains(Scene& scene, Report& report);

}  // namespace bendy::converter
