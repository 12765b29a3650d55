#pragma once

#include <bendy/format/public.h>
#include <bendy/runtime/constraint.h>
#include <bendy/runtime/pose.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace BENDY_PUBLIC bendy {

/// The legal rotation nearest to R by angle; see Constraint for R. Inside the limits it is R itself, clamping twice is
/// clamping once, and nothing jumps where an angle passes pi. For the Euler box it is the nearest that an ascent over
/// the three angles finds from several starts. Same result on every machine.
/// \param R  unit quaternion
[[nodiscard]] glm::dquat clamp_rotation(const Constraint& constraint, const glm::dquat& R);

/// How far R is from the nearest legal rotation, radians.
[[nodiscard]] double violation(const Constraint& constraint, const glm::dquat& R);

/// R of a joint: conj(C) * conj(rest) * local * C. And back.
[[nodiscard]] glm::dquat to_constraint_space(const Constraint& constraint, const glm::quat& rest,
                                             const glm::quat& local);
[[nodiscard]] glm::quat from_constraint_space(const Constraint& constraint, const glm::quat& rest, const glm::dquat& R);

/// A joint's translation held to the constraint, metres: each component of d in its range, where
/// translation = rest.translation + rest.rotation * C * d.
[[nodiscard]] glm::vec3 clamp_translation(const Constraint& constraint, const JointTransform& rest,
                                          const glm::vec3& translation);

/// Brings every joint of a pose inside its constraints, those for the IK solver only excepted.
void constrain(Pose& pose);

}  // namespace bendy
