#pragma once

#include "humanoid.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <optional>

namespace bendy::converter {

/// What a VRM extension says of a character.
struct VrmHumanoid {
    Humanoid bones;
    bool faces_backward = false;  ///< VRM 0.x: looks along -Z; 1.0 along +Z
    const char* place = "";       ///< JSON path of the humanoid
};

/// The humanoid of VRMC_vrm (1.0) or VRM (0.x) in Scene::extensions, whose nodes are joint numbers there; nothing if
/// the scene has none. What is malformed is named in `report`, by JSON path, and left out.
std::optional<VrmHumanoid> read_vrm_humanoid(const Scene& scene, Report& report);

/// Adds a VRM humanoid's chains (see make_limb_chains) whose names are not taken.
void add_vrm_chains(Scene& scene, Report& report);

}  // namespace bendy::converter
