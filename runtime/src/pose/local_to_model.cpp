#include "kernels/flush_denormals.h"
#include "kernels/pose_kernels.h"
#include "pose_state.h"

#include <cstdint>

namespace bendy {

void PoseState::find_model_space() {
    palette_mesh = kNone;
    const PoseKernels* const kernels = pose_kernels();  // once, since another thread may choose another one
    const bool was_exact = is_exact;
    is_exact = kernels == nullptr || !data->pose_plan->fits_floats;
    if (is_exact != was_exact) stale.mark_all();  // another kernel is in use
    std::uint32_t changed = 0;
    for (const StaleJoints::Subtree& subtree : stale.subtrees()) changed += subtree.end - subtree.joint;
    if (stale.are_all() || changed > joint_count() / 2) {
        find_subtree({0, joint_count()}, kernels);
    } else {
        for (const StaleJoints::Subtree& subtree : stale.subtrees()) find_subtree(subtree, kernels);
    }
    stale.clear();
}

void PoseState::find_subtree(const StaleJoints::Subtree& subtree, const PoseKernels* kernels) {
    if (joint_count() == 0) return;
    if (is_exact) return find_exactly(subtree);
    const FlushDenormals flush;
    const PoseBlock block{joint_count(), &local.front().rotation[0][0], data->parents.data(),
                          data->pose_plan->order.data(), &model_space.front().matrix[0].x};
    if (subtree.end - subtree.joint == joint_count()) {
        kernels->pose(block);
    } else {
        kernels->pose_subtree(block, subtree.joint, subtree.end);
    }
}

void PoseState::find_exactly(const StaleJoints::Subtree& subtree) {
    const std::vector<Joint>& joints = data->joints;
    for (std::uint32_t joint = subtree.joint; joint < subtree.end; ++joint) {
        const glm::dmat4 matrix = to_matrix(local_of(joint), joints[joint].shear);
        const std::uint32_t parent = joints[joint].parent;
        exact_model_space[joint] = parent == kNone ? matrix : exact_model_space[parent] * matrix;
        model_space[joint].matrix = glm::mat4(exact_model_space[joint]);
    }
}

}  // namespace bendy
