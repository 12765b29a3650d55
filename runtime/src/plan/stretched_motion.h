#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace bendy {

/// A palette entry for skinning by dual quaternions: v -> rigid motion of (stretch * v + shift).
struct StretchedMotion {
    glm::dquat real{1.0, 0.0, 0.0, 0.0};  ///< real part of the rigid motion as a dual quaternion; unit
    glm::dquat dual{0.0, 0.0, 0.0, 0.0};
    glm::dmat3 stretch{1.0};
    glm::dvec3 shift{0.0};
};

}  // namespace bendy
