#pragma once

#include <bendy/runtime/ik.h>

#include <glm/mat4x4.hpp>

#include <cstdint>
#include <optional>

// The short way of plain chains: straight from the pose to the closed form and back, without an IkProblem.
namespace bendy {

/// Two bones or an aim of one joint, where nothing is asked for but a position and the limits do not matter: the pose
/// that comes out is that of the long way but for rounding. Nothing, and the pose as it was, where a chain, a target or
/// an option needs more.
std::optional<ReachResult> reach_quickly(const Chain& chain, const ReachTarget& target, Pose& pose,
                                         const ReachOptions& options);

/// What reach does with a chain that has no short way; a target of finite numbers.
/// Nothing, and the pose as it was, if a number of the pose, the chain or the target is not finite.
std::optional<ReachResult> reach_at_length(const Chain& chain, const ReachTarget& target, Pose& pose,
                                           const ReachOptions& options);

/// A joint's matrix, joint space to model space, from the local transforms alone where the pose has changed; kNone:
/// one.
glm::dmat4 joint_to_model(const Pose& pose, std::uint32_t joint);

}  // namespace bendy
