#pragma once

#include "find_humanoid.h"
#include "humanoid.h"
#include "scene/rest_frames.h"

#include <bendy/converter/scene.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace bendy::converter {

/// A whole human from the limbs and the head that were found, with all its bones, fingers and face; checks that they
/// belong to one upright body. Nothing if they do not.
std::optional<Humanoid> complete_human(const Scene& scene, const RestFrames& rest, const NamedHumanoid& found);

/// The joints from one below `top` down to `joint`, without `joint`.
std::vector<std::uint32_t> joints_between(const Scene& scene, std::uint32_t top, std::uint32_t joint);

}  // namespace bendy::converter
