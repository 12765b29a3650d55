#pragma once

#include <bendy/format/public.h>
#include <bendy/runtime/constraint.h>
#include <bendy/runtime/pose.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace BENDY_PUBLIC bendy {

/// Returns the legal rotation nearest to R by angle; see Constraint for R. A rotation inside the limits is returned
/// unchanged, clamping twice gives the same as clamping once, and the result is continuous where an angle passes pi.
/// For the Euler box it is the nearest rotation found by ascent over the three angles from several starting points. The
/// result is the same on every machine.
/// \param R  unit quaternion
[[nodiscard]] glm::dquat clamp_rotation(const Constraint& constraint, const glm::dquat& R);

/// Returns the angle between R and the nearest legal rotation, in radians.
[[nodiscard]] double violation(const Constraint& constraint, const glm::dquat& R);

/// Converts a joint's local rotation to R = conj(C) * conj(rest) * local * C, and back.
[[nodiscard]] glm::dquat to_constraint_space(const Constraint& constraint, const glm::quat& rest,
                                             const glm::quat& local);
[[nodiscard]] glm::quat from_constraint_space(const Constraint& constraint, const glm::quat& rest, const glm::dquat& R);

/// Returns the rotation at a fraction of the way between two that are inside the limits. The way stays inside: it does
/// not follow the shorter arc, which may lead through what is forbidden, but the numbers that the limits are about
/// (angles, twist, tangents of half a swing). Of constraints for which these do not describe the limits (a largest
/// angle, a soft zone, an ellipse of half a turn or more), the shorter arc is taken and clamped.
/// \param a, b   unit quaternions, R of Constraint; moved inside first
/// \param share  0 to 1
[[nodiscard]] glm::dquat between_legal(const Constraint& constraint, const glm::dquat& a, const glm::dquat& b,
                                       double share);

/// Clamps a joint's translation to the constraint, metres: each component of d to its range, where translation =
/// rest.translation + rest.rotation * C * d.
[[nodiscard]] glm::vec3 clamp_translation(const Constraint& constraint, const JointTransform& rest,
                                          const glm::vec3& translation);

/// Moves every joint of a pose into the range of its constraints, except those for the IK solver only.
void constrain(Pose& pose);

}  // namespace bendy
