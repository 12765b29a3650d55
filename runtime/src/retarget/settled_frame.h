#pragma once

#include "retarget_plan.h"

#include "pose/pose_state.h"

#include <bendy/runtime/retarget.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace bendy {

/// A limb in one frame, model space.
struct LimbFrame {
    double extended = 0.0;                ///< metres from its start to its end, as in the source
    glm::dvec3 wanted{0.0};               ///< of its end
    glm::dvec3 below{0.0};                ///< from its end to its foot or hand
    glm::dvec3 bend{0.0};                 ///< unit: where knee or elbow point
    glm::dquat turn{1.0, 0.0, 0.0, 0.0};  ///< of its end
    double joined = 0.0;                  ///< how far `wanted` is decided by the other hand or the own body: 0 to 1
    double planted = 0.0;                 ///< how far `wanted` is decided by the ground: 0 to 1
};

/// One frame of the target while limits and contacts act.
struct SettledFrame {
    SettledFrame(RetargetPlan& of, Pose& source_pose, Pose& target_pose)
        : plan(of), source(PoseState::of(source_pose)), pose(target_pose), to(PoseState::of(target_pose)) {}

    [[nodiscard]] glm::dvec3 place(std::uint32_t joint) const { return {to.fresh_matrix(joint)[3]}; }

    RetargetPlan& plan;
    PoseState& source;
    Pose& pose;
    PoseState& to;
    static constexpr std::size_t kMostLimbs = 4;
    std::array<LimbFrame, kMostLimbs> limbs{};
    double lying = 0.0;                                            ///< how firmly the body is on the ground
    double body_height = std::numeric_limits<double>::infinity();  ///< metres, as the source's: infinite if unknown
    Retargeted result;
};

}  // namespace bendy
