#pragma once

#include <bendy/format/public.h>
#include <bendy/format/result.h>
#include <bendy/runtime/call_error.h>
#include <bendy/runtime/pose.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>

// Inverse kinematics: chains of the model reach for targets, inside their joints' constraints.
namespace BENDY_PUBLIC bendy {

/// What a chain is to reach, in model space.
struct ReachTarget {
    glm::vec3 position{0.0f};           ///< metres
    std::optional<glm::quat> rotation;  ///< of the tip; counts by the chain's rotation weight, 1 if that is 0

    ReachTarget() = default;
    // NOLINTNEXTLINE(google-explicit-constructor): a point is a target
    ReachTarget(const glm::vec3& where) : position(where) {}
    ReachTarget(const glm::vec3& where, const glm::quat& orientation) : position(where), rotation(orientation) {}
};

/// Whatever is left at its default is taken from the chain, and where that says nothing, from the solver.
struct ReachOptions {
    Solver solver = Solver::any;
    std::uint32_t iterations = 0;  ///< at most; of least squares: for each beginning
    float tolerance = 0.0f;   ///< metres, default 0.0001 of the chain's length; radians, of that number, for rotation
    float influence = 1.0f;   ///< 0 to 1: how much of the solution is mixed into the pose
    float softness = 0.0f;    ///< 0 to 1: two-bone: the share of its length over which the chain slows near full reach
    float gain = 1.0f;        ///< pull: radians per chain length of distance
    float step_limit = 0.2f;  ///< pull: radians per joint and call
    std::uint32_t restarts = 8;     ///< least squares: other beginnings that it tries when it is stuck
    std::optional<glm::vec3> pole;  ///< two-bone, aim: point in model space; default: the chain's pole joint or vector
    bool obey_constraints = true;
    /// Afterwards, moves the joint that the chain follows to the tip, with everything below it: a foot that is not a
    /// child of its leg stays at the leg's end. Has no effect if the chain follows no joint, or one that is in, above
    /// or below the chain.
    bool carry_target = false;
};

enum class ReachStatus : std::uint8_t {
    reached,       ///< the tip is at the target, within the tolerance
    out_of_reach,  ///< farther than the chain is long: it points at the target
    not_reached,   ///< stopped at the nearest that was found; of aim: the tip does not point at the target
    aimed,         ///< of aim alone: the tip's Z axis points at the target within the tolerance, however far it is
};

/// Of the whole solution, also where the influence mixes in less.
struct ReachResult {
    ReachStatus status = ReachStatus::not_reached;
    float distance = 0.0f;  ///< metres between tip and target; aim leaves it about as it is
    /// Radians left: between the tip's orientation and the target's, 0 if the target has none; of aim: between the
    /// tip's Z axis and the line to the target.
    float angle = 0.0f;
    std::uint32_t iterations = 0;  ///< that were made
};

/// Moves a chain of the pose's model so that its tip (the effector's tip offset) reaches the target. The incoming pose
/// is the beginning, and is brought inside the constraints first. Joints outside the chain stay as they are, unless
/// options.carry_target. Allocates nothing. The same numbers give the same pose on every machine with the plain kernel
/// (kernels.h); others find the joint matrices that it begins with to their own last digit.
///     pull           Anderson's and Elias' force; one step a call, so it takes frames to arrive
///     two_bone       closed form; of a longer chain, start and middle joint turn
///     ccd            cyclic coordinate descent, from the tip up
///     fabrik         forward and backward reaching, both passes inside the constraints
///     aim            turns the tip's Z axis towards the target, by a share from each joint: looking at it
///     least_squares  damped least squares, with restarts: the most reliable
/// Where two_bone, ccd or fabrik stops short of a target that is no farther than the chain is long, least_squares goes
/// on from there; iterations and restarts hold for it too. Solver::any: two_bone for chains of two bones, else
/// least_squares. A mirrored chain and target come out mirrored, if the chain is bent, has a pole, or its constraints
/// let it turn farther to one side.
/// A target that is not reached is a result, not an error. An error, and the pose as it was: chain is null, or a number
/// of the pose or the target is not finite.
[[nodiscard]] Result<ReachResult, CallError> reach(Pose& pose, const Chain* chain, const ReachTarget& target,
                                                   const ReachOptions& options = {});

/// Runs every chain that follows a target joint, in the order of their priority, with the chains' own influence.
void reach_all(Pose& pose);

}  // namespace bendy
