#pragma once

#include <bendy/format/public.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace BENDY_PUBLIC bendy {

/// A joint's transform relative to its parent.
struct JointTransform {
    glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f};  ///< unit; glm's constructor takes w first
    glm::vec3 translation{0.0f};                 ///< metres, in the parent's space
    glm::vec3 scale{1.0f};                       ///< along the joint's axes; may be negative or zero
};

/// Returns T * R * U; U is upper triangular with the scale on its diagonal and `shear` (xy, xz, yz) above it.
[[nodiscard]] glm::dmat4 to_matrix(const JointTransform& transform, const glm::vec3& shear);

}  // namespace bendy
