#pragma once

#include <bendy/runtime/constraint.h>
#include <bendy/runtime/pose.h>

#include <cstdint>

namespace bendy {

/// Which legal rotation a joint gets that is outside.
enum class Legal : std::uint8_t {
    nearest,  ///< by angle
    quick,    ///< near, at a small part of the cost: see quick_legal_rotation
};

/// Moves a joint of the pose into the range of a constraint of the pose's model. Returns the angle by which it turned,
/// in radians: 0 if it was inside.
double constrain_joint(Pose& pose, const Constraint& constraint, Legal which);

}  // namespace bendy
