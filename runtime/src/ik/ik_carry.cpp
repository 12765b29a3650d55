#include "ik_carry.h"

#include "pose/pose_state.h"

#include <glm/gtc/matrix_inverse.hpp>
#include <glm/matrix.hpp>

#include <cmath>
#include <span>

namespace bendy {

glm::dvec3 tip_offset(const Chain& chain) {
    const auto& offset = chain.record.tip_offset;
    return {offset[0], offset[1], offset[2]};
}

std::uint32_t carried_joint(const Chain& chain, const Pose& pose, const ReachOptions& options) {
    const std::uint32_t start = chain.record.start, target = chain.record.target;
    if (!options.carry_target || target == kNone) return kNone;
    const PosePlan& plan = *PoseState::of(pose).data->pose_plan;
    return plan.is_at_or_below(target, start) || plan.is_at_or_below(start, target) ? kNone : target;
}

void carry_to_tip(const Chain& chain, std::uint32_t joint, Pose& pose) {
    if (joint == kNone) return;
    PoseState& state = PoseState::of(pose);
    const std::span<const std::uint32_t> parents = state.data->parents;
    const glm::dmat4 space = state.fresh_matrix(parents[joint]);
    if (!(std::abs(glm::determinant(space)) >= 1e-30)) return;
    // Along the links, since the matrices of all that hangs on them would take longer.
    glm::dvec4 tip(tip_offset(chain), 1.0);
    const std::uint32_t above = parents[chain.record.start];
    for (std::uint32_t link = chain.record.effector; link != above; link = parents[link])
        tip = to_matrix(state.local_of(link), pose.model().joints()[link].shear) * tip;
    JointTransform local = pose.local(joint);
    local.translation = glm::vec3(glm::affineInverse(space) * (state.fresh_matrix(above) * tip));
    pose.set_local(joint, local);
}

}  // namespace bendy
