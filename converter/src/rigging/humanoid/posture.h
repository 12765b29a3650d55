#pragma once

#include "find_humanoid.h"
#include "limb_chains.h"
#include "scene/rest_frames.h"

#include <optional>

namespace bendy::converter {

/// The orientation of a character at rest.
struct Posture {
    Stance stance;
    bool is_upright = false;       ///< the spine goes up from the legs, as a human's does
    bool has_feet_forward = true;  ///< the toes point forward as given by left and right
};

/// Left is where the left limbs are, up is where the spine goes or the legs come from; forward follows. Nothing if that
/// does not give axes.
std::optional<Posture> measure_posture(const RestFrames& rest, const NamedHumanoid& found);

}  // namespace bendy::converter
