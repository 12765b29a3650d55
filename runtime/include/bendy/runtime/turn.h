#pragma once

#include <bendy/format/public.h>
#include <bendy/runtime/constraint.h>

#include <glm/gtc/quaternion.hpp>

namespace BENDY_PUBLIC bendy {

/// Returns the angle between two rotations, radians; accurate for small ones too.
/// \param a, b  unit quaternions
[[nodiscard]] double turn_between(const glm::quat& a, const glm::quat& b);

/// Returns a joint's rotation on the way from one to another. Inside its limits the way stays inside, as that of
/// between_legal; by what the two are beyond, it is beyond.
/// \param constraint  of the joint; null: none
/// \param rest        the joint's rotation at rest
/// \param share       0 to 1
[[nodiscard]] glm::quat turn_part_way(const Constraint* constraint, const glm::quat& rest, const glm::quat& from,
                                      const glm::quat& to, double share);

/// The same, but as far as the angle from the first allows, radians.
[[nodiscard]] glm::quat turn_towards(const Constraint* constraint, const glm::quat& rest, const glm::quat& from,
                                     const glm::quat& to, double most);

}  // namespace bendy
