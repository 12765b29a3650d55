#pragma once

#include <glm/ext/quaternion_float.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>

namespace bendy::motion {

/// Returns the angle between two rotations, in radians; accurate for small ones too.
inline double turn_between(const glm::quat& a, const glm::quat& b) {
    const glm::dquat by = glm::conjugate(glm::dquat(a)) * glm::dquat(b);
    return 2.0 * std::asin(std::min(1.0, glm::length(glm::dvec3(by.x, by.y, by.z))));
}

}  // namespace bendy::motion
