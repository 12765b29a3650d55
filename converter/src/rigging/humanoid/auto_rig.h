#pragma once

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <vector>

namespace bendy::converter {

/// Proposes IK chains and anatomical limits for a character with human joint names or a VRM humanoid. Skips
/// joints that have limits or are `claimed`, and chains whose names are taken. Everything is flagged kProposed and
/// listed in `report`. A four-legged animal with human joint names gets chains only.
/// \param claimed  by joint: another source has decided that it has no limits; empty: none has
void auto_rig(Scene& scene, const std::vector<bool>& claimed, Report& report);

/// Adds a VRM humanoid's chains (see make_limb_chains), unless a chain of that name exists.
void add_vrm_chains(Scene& scene, Report& report);

}  // namespace bendy::converter
