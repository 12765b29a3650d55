#pragma once

#include <bendy/runtime/ik.h>

#include <optional>

// A fast path for simple chains: from the pose directly to the closed form and back, without an IkProblem.
namespace bendy {

/// Solves two bones, or an aim of one joint, if only a position is asked for and the limits do not matter; the
/// resulting pose is that of the general solver except for rounding. Returns nothing, and leaves the pose unchanged, if
/// the chain, the target or an option needs more.
std::optional<ReachResult> reach_quickly(const Chain& chain, const ReachTarget& target, Pose& pose,
                                         const ReachOptions& options);

/// What reach does with a chain that has no fast path; the target's numbers are finite.
///
/// Returns nothing, and leaves the pose unchanged, if a number in the pose, the chain or the target is not finite.
std::optional<ReachResult> reach_at_length(const Chain& chain, const ReachTarget& target, Pose& pose,
                                           const ReachOptions& options);

}  // namespace bendy
