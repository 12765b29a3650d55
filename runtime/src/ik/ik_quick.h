#pragma once

#include <bendy/runtime/ik.h>

#include "plan/blocks.h"

#include <glm/gtc/quaternion.hpp>

#include <cstddef>
#include <optional>

// A fast path for simple chains: from the pose directly to the closed form and back, without an IkProblem.
namespace bendy {

/// Solves two bones, or an aim of one joint, if only a position is asked for and the result is inside the limits; a
/// start outside of them is moved inside first. The resulting pose is that of the general solver except for rounding.
/// Returns nothing, and leaves the pose unchanged, if the chain, the target or an option needs more.
std::optional<ReachResult> reach_quickly(const Chain& chain, const ReachTarget& target, Pose& pose,
                                         const ReachOptions& options);

/// Returns true if a chain consists of two bones that reach_quickly may solve.
bool is_plain_limb(const Chain& chain, const ReachTarget& target, const Pose& pose, const ReachOptions& options);

/// Reads such a chain's joints and target into one of the limbs; returns false if reach_quickly would not solve it.
template <std::size_t count>
bool gather_limb(const Chain& chain, const ReachTarget& target, Pose& pose, const ReachOptions& options,
                 TwoBoneLimbs<count>& limbs, std::size_t number);
extern template bool gather_limb(const Chain&, const ReachTarget&, Pose&, const ReachOptions&,
                                 TwoBoneLimbs<TwoBoneBlock::kLimbs>&, std::size_t);

/// Returns true if such a chain's limits allow these rotations of its start and its middle joint.
bool are_legal(const Chain& chain, const Pose& pose, const ReachOptions& options, const glm::dquat& upper,
               const glm::dquat& lower);

/// Moves such a chain's effector inside its limits, as the other solvers do.
void make_end_legal(const Chain& chain, Pose& pose, const ReachOptions& options);

struct ReachStart;

/// Reaches with a chain that has no fast path, for a target with finite numbers.
/// \param start  the rotations to begin with, without others if they do not reach; null: those of the pose
///
/// Returns nothing, and leaves the pose unchanged, if a number in the pose, the chain or the target is not finite, or
/// if a pole decides the pose, whatever the start.
std::optional<ReachResult> reach_at_length(const Chain& chain, const ReachTarget& target, Pose& pose,
                                           const ReachOptions& options, const ReachStart* start = nullptr);

}  // namespace bendy
