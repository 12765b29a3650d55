#pragma once

#include <bendy/format/public.h>
#include <bendy/format/records.h>
#include <bendy/format/result.h>
#include <bendy/runtime/call_error.h>
#include <bendy/runtime/pose.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

namespace bendy {

struct BodyReachPlan;  // internal

}  // namespace bendy

// Full-body IK: hands, feet and head reach for targets at the same time, with the spine and the hips that they share.
namespace BENDY_PUBLIC bendy {

/// A point of a joint that is to reach for a target.
struct Effector {
    std::uint32_t joint = kNone;
    glm::vec3 tip_offset{0.0f};  ///< metres, in the joint's space
};

/// Where an effector is to be, in model space.
struct EffectorTarget {
    glm::vec3 position{0.0f};           ///< metres
    std::optional<glm::quat> rotation;  ///< orientation of the effector's joint
    float weight = 1.0f;           ///< 0 to 1, beside the other effectors' where not all can be reached; 0: anywhere
    float rotation_weight = 1.0f;  ///< the same for the rotation
};

struct BodyReachOptions {
    /// The topmost joint that moves. It is above all effectors, or one of theirs. kNone: the nearest such joint.
    std::uint32_t root = kNone;
    /// Metres along the axes of model space, each way: how far the root may move from its place in the pose.
    glm::vec3 root_shift{0.0f};
    float root_turn = 0.0f;         ///< radians: how far the root may turn from its orientation in the pose
    std::uint32_t iterations = 60;  ///< maximum for each starting point
    std::uint32_t restarts = 2;     ///< number of other starting points to try when it is stuck
    float tolerance = 0.0f;  ///< metres, default 0.0001 of the longest way from the root to an effector; for rotations
                             ///< the same part in radians
    bool obey_constraints = true;
};

/// Describes the solution.
struct BodyReached {
    bool is_reached = false;       ///< every effector is at its target, within the tolerance
    std::uint32_t farthest = 0;    ///< the effector that is farthest from its target; of those with a weight
    float distance = 0.0f;         ///< metres, of that one
    float angle = 0.0f;            ///< radians: largest between an effector's orientation and its target's
    std::uint32_t iterations = 0;  ///< number of iterations made
};

/// The joints between a root and several effectors. Making one allocates; reaching with it does not. Contains work
/// memory, so each thread needs one of its own (a copy will do).
class BodyReach {
public:
    static constexpr std::size_t kMostEffectors = 32;

    /// Errors: missing, if no effector is given; wrong_size, if there are more than kMostEffectors; out_of_range, if
    /// the model has no such joint, or the root is not at or above each effector; not_finite.
    static Result<BodyReach, CallError> make(const Model& model, std::span<const Effector> effectors,
                                             const BodyReachOptions& options = {});
    BodyReach(const BodyReach& other);
    BodyReach(BodyReach&& other) noexcept;
    BodyReach& operator=(const BodyReach& other);
    BodyReach& operator=(BodyReach&& other) noexcept;
    ~BodyReach();

    [[nodiscard]] const Model& model() const;
    /// The joint that options.root names, or the one that was found.
    [[nodiscard]] std::uint32_t root() const;

private:
    friend struct BodyReachPlan;
    explicit BodyReach(std::unique_ptr<BodyReachPlan> plan);

    std::unique_ptr<BodyReachPlan> plan_;
};

/// Moves the joints between the root and the effectors so that each effector is at its target, or as near to it as all
/// targets, weighted, allow. One solve by damped least squares over all joints, inside their constraints, each with the
/// freedom that its stiffness leaves. The current pose is the starting point, so a result that follows a motion stays
/// near it; it is first brought inside the constraints. IK chains play no part.
///
/// A target that is not reached is a result, not an error. Errors: other_model; wrong_size, unless there is one target
/// for each effector; not_finite, if a number in the pose or a target is not, or a rotation has no unit length. The
/// pose is then unchanged.
[[nodiscard]] Result<BodyReached, CallError> reach(Pose& pose, BodyReach& body,
                                                   std::span<const EffectorTarget> targets);

}  // namespace bendy
