#pragma once

#include "humanoid.h"

#include <bendy/converter/scene.h>

#include <glm/vec3.hpp>

#include <optional>
#include <vector>

namespace bendy::converter {

/// The pose in which a human stands as its names and the lengths of its bones alone say it: a T, with Y up, that looks
/// along Z. Bones that the names give a direction have it: spine up, legs down, arms to their sides, feet and toes
/// ahead. About their own length they are turned by what the skeleton or its clips show: hips and chest by where the
/// limbs leave them, limbs by the axis about which knee, elbow and toes bend most, hands by their knuckles, the head by
/// its eyes. Whatever shows nothing, such as a neck or a thumb, is as it is in `base`, beside the bone above.
/// \param base  by joint, relative to its parent: a pose of the body, whichever it is
/// \param up    where it points up, if the body stands in `base`: feet are slanted as they are there
std::vector<Transform> assume_stand(const Scene& scene, const Humanoid& bones, const std::vector<Transform>& base,
                                    const std::optional<glm::dvec3>& up);

}  // namespace bendy::converter
