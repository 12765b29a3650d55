#pragma once

#include "clip_rotations.h"
#include "humanoid.h"
#include "rest_frames.h"

#include <bendy/converter/scene.h>

#include <optional>
#include <vector>

namespace bendy::converter {

struct ShapedHumanoid {
    Humanoid bones;
    bool contradicts_names = false;  ///< left and right are the other way round than pairs of names say
};

/// A humanoid found by its skeleton's shape alone: two pairs of limbs that are each other's mirror images, of two long
/// bones each, one pair that the character stands on and one above it, on a trunk that goes up from the legs. Animals
/// on four legs, hands and vehicles have none. Left and right, which the shape leaves open, are what pairs of names
/// say (`lhip`, `rhip`), which way the toes and knees point, and how the clips bend knees and elbows: together these
/// outweigh names. Where all are silent the character looks along +Z, as glTF asks.
/// \param chosen  by joint: only these are looked at
std::optional<ShapedHumanoid> find_by_shape(const Scene& scene, const RestFrames& rest, const ClipRotations& clips,
                                            const std::vector<bool>& chosen);

/// Fills in hips, spine, neck and head where they are not known: what lies between the legs and the arms, and what goes
/// on upward from there.
void find_trunk_by_shape(const Scene& scene, const RestFrames& rest, const std::vector<bool>& chosen,
                         Humanoid& humanoid);

}  // namespace bendy::converter
