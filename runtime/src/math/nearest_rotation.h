#pragma once

#include <bendy/runtime/constraint.h>

#include <glm/gtc/quaternion.hpp>

namespace bendy {

/// Returns the rotation in a shape of the constraint that is nearest to R by angle; R itself if it is inside.
glm::dquat nearest_rotation(const ConstraintView& constraint, const LimitShape& shape, const glm::dquat& R);

/// Returns a legal rotation near R, for the solvers' many small steps: as nearest_rotation, but swing and twist are
/// clamped separately, and of the Euler forms only the better one is tried.
glm::dquat quick_legal_rotation(const ConstraintView& constraint, const LimitShape& shape, const glm::dquat& R);

}  // namespace bendy
