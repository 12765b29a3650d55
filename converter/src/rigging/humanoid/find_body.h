#pragma once

#include "clip_rotations.h"
#include "find_humanoid.h"
#include "limb_chains.h"
#include "quadruped.h"
#include "scene/rest_frames.h"

#include <bendy/converter/scene.h>

#include <optional>
#include <vector>

namespace bendy::converter {

/// The body in a skeleton: a four-legged animal, or else what there is of a human.
struct FoundBody {
    std::optional<Quadruped> animal;
    NamedHumanoid human;
};

/// Looks for a human by names; if that does not give an upright body with all limbs, for an animal, and for the missing
/// parts of a human by shape.
/// \param among  by joint: only these are considered
FoundBody find_body(const Scene& scene, const RestFrames& rest, const ClipRotations& clips,
                    const std::vector<bool>& among);

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
