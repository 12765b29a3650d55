#pragma once

#include <bendy/runtime/constraint.h>
#include <bendy/runtime/pose.h>

namespace bendy {

/// Moves a joint of the pose into the range of a constraint of the pose's model. Returns the angle by which it turned,
/// in radians: 0 if it was inside.
double constrain_joint(Pose& pose, const Constraint& constraint);

}  // namespace bendy
