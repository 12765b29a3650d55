#pragma once

#include <bendy/format/public.h>
#include <bendy/format/result.h>
#include <bendy/runtime/call_error.h>
#include <bendy/runtime/pose.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <span>

// Inverse kinematics: makes chains of the model reach for targets, within their joints' constraints.
namespace BENDY_PUBLIC bendy {

class ReachState;

/// The target of a chain, in model space.
struct ReachTarget {
    glm::vec3 position{0.0f};           ///< metres
    std::optional<glm::quat> rotation;  ///< orientation of the tip; weighted by the chain's rotation weight, or 1 if
                                        ///< that is 0

    ReachTarget() = default;
    // NOLINTNEXTLINE(google-explicit-constructor): a point is a target
    ReachTarget(const glm::vec3& where) : position(where) {}
    ReachTarget(const glm::vec3& where, const glm::quat& orientation) : position(where), rotation(orientation) {}
};

/// Options of reach. Defaults are taken from the chain or, if the chain has none, from the solver.
struct ReachOptions {
    Solver solver = Solver::any;
    std::uint32_t iterations = 0;  ///< maximum; least squares: for each starting point
    float tolerance = 0.0f;   ///< metres, default 0.0001 of the chain's length; for rotation the same number in radians
    float influence = 1.0f;   ///< 0 to 1: how far the solution is blended into the pose
    float softness = 0.005f;  ///< 0 to 1: the share of its length over which a chain slows near full reach, where a
                              ///< straight knee would snap: the tip stays behind the target by up to that share. Not
                              ///< of aim and pull, nor of a chain that can stretch; 0: off
    float gain = 1.0f;        ///< pull: radians per chain length of distance
    float step_limit = 0.2f;  ///< pull: radians per joint and call
    std::uint32_t restarts = 4;  ///< number of other poses to start from, at most 4, where the first one does not reach
    std::optional<glm::vec3> pole;  ///< two-bone, aim: point in model space; default: the chain's pole joint or vector
    bool obey_constraints = true;
    /// Afterwards, moves the joint that the chain follows, with its descendants, to the tip: a foot that is not a child
    /// of its leg then stays at the leg's end. Has no effect if the chain follows no joint, or one that is in, above or
    /// below the chain.
    bool carry_target = true;
    /// What the chains of this character did last, for chains that reach in frame after frame; null: each call is by
    /// itself. Not of pull, which takes several frames itself.
    ReachState* state = nullptr;
    float seconds = 0.0f;      ///< with a state: since the last call, 0 to 1
    float speed_limit = 4.0f;  ///< with a state: radians per second, 0 or more: how fast a chain goes from one pose to
                               ///< another, beyond what the pose that comes in and the target turn it
};

enum class ReachStatus : std::uint8_t {
    reached,       ///< the tip is at the target, within the tolerance and what the softness keeps it behind
    out_of_reach,  ///< the target is farther away than the chain is long: it points there, within its limits
    not_reached,   ///< stopped at the nearest solution found; aim: the tip does not point at the target
    aimed,         ///< only aim: the tip's Z axis points at the target within the tolerance, at any distance
};

/// Describes the full solution, even if `influence` blends in only part of it.
struct ReachResult {
    ReachStatus status = ReachStatus::not_reached;
    float distance = 0.0f;  ///< metres between tip and target; aim hardly changes it
    /// Remaining angle in radians: between the tip's orientation and the target's, 0 if the target has none; aim:
    /// between the tip's Z axis and the line to the target.
    float angle = 0.0f;
    std::uint32_t iterations = 0;  ///< number of iterations made
};

/// Moves a chain of the pose's model so that its tip (the effector's tip offset) reaches the target. The current pose
/// is the starting point, and is first brought inside the constraints. Joints outside the chain are unchanged, but for
/// the one that options.carry_target moves. Allocates nothing. With the plain kernel (kernels.h) the same input gives
/// the same pose on every machine; with other kernels the joint matrices at the start may differ in the last digit.
///     pull           Anderson's and Elias' force; one step per call, so it takes several frames to arrive
///     two_bone       closed form; in a longer chain, the start and a middle joint turn
///     aim            turns the tip's Z axis towards the target, as in looking at it; each joint does a share
///     least_squares  all joints at once. Up to 10 links, by Newton's method in the coordinates of the limits: what the
///                    target leaves open stays nearest to the pose that came in, so that the result follows pose and
///                    target smoothly; longer chains, by damped least squares in the same coordinates. At most 20
///                    iterations for each link
///     ccd, fabrik    as least_squares: names that files hold for programs that have these solvers
/// If two_bone stops short of its target, least_squares continues from there; iterations and restarts apply to it too.
/// Where limits forbid to reach, a few other poses are tried as starts, and the one that comes nearest counts: see
/// docs/decisions/0083. Solver::any: two_bone for chains of two bones, otherwise least_squares. A mirrored chain and
/// target give a mirrored result, provided that the chain is bent, has a pole, or its constraints allow it to turn
/// farther to one side.
///
/// With a state, the result is continuous over time: a chain stays inside its limits, then obeys options.speed_limit,
/// and only then reaches; the result says how far it is off meanwhile.
///
/// A target that is not reached is a result, not an error. Returns an error, and leaves the pose unchanged, if the
/// chain is null, if it or the state does not belong to the pose's model, or if a number in the pose or the target is
/// not finite.
[[nodiscard]] Result<ReachResult, CallError> reach(Pose& pose, const Chain* chain, const ReachTarget& target,
                                                   const ReachOptions& options = {});

/// A chain to move, as for reach.
struct ReachRequest {
    const Chain* chain = nullptr;
    ReachTarget target;
    ReachOptions options;
};

/// As reach for one request after another, with the same pose as the result; faster, since limbs of two bones that do
/// not move one another, such as arms and legs, are solved side by side. A request that is an error leaves its chain
/// unchanged and has a result of zeros; all others are solved, and the first such error is returned.
/// \param results  empty, or one for each request
[[nodiscard]] Result<void, CallError> reach(Pose& pose, std::span<const ReachRequest> requests,
                                            std::span<ReachResult> results = {});

/// Solves every chain that follows a target joint, in order of priority, with each chain's own influence. The joints
/// that are followed stay where they are.
/// \param state    as ReachOptions::state; one of another model is not used
/// \param seconds  since the last call with that state
void reach_all(Pose& pose, ReachState* state = nullptr, float seconds = 0.0f);

}  // namespace bendy
