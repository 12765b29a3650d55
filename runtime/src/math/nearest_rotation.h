#pragma once

#include <bendy/runtime/constraint.h>

#include <glm/gtc/quaternion.hpp>

#include <array>

namespace bendy {

/// Returns the rotation in a shape of the constraint that is nearest to R by angle; R itself if it is inside.
glm::dquat nearest_rotation(const ConstraintView& constraint, const LimitShape& shape, const glm::dquat& R);

/// Returns a legal rotation near R, for the solvers' many small steps: as nearest_rotation, but swing and twist are
/// clamped separately, and of the Euler forms only the better one is tried.
glm::dquat quick_legal_rotation(const ConstraintView& constraint, const LimitShape& shape, const glm::dquat& R);

/// Returns how far R is outside a shape of the constraint, for searches: 0 inside; outside continuous, and near the
/// edge about the angle to it in radians.
double excess(const ConstraintView& constraint, const LimitShape& shape, const glm::dquat& R);

/// Returns the Euler angles of R in the order of an Euler box: of the two forms the one nearer to the box.
std::array<double, 3> euler_angles(const ConstraintView& constraint, const LimitShape& shape, const glm::dquat& R);

}  // namespace bendy
