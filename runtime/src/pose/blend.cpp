#include <bendy/runtime/blend.h>

#include "kernels/flush_denormals.h"
#include "kernels/kernel_table.h"
#include "pose_state.h"

#include <cmath>
#include <cstddef>

namespace bendy {
namespace {

Result<void, CallError> check_blend(const Pose& pose, const Pose& other, float weight, std::span<const float> mask) {
    if (pose.model() != other.model()) return CallError::other_model;
    if (!std::isfinite(weight)) return CallError::not_finite;
    if (!mask.empty() && mask.size() != pose.model().joints().size()) return CallError::wrong_size;
    return {};
}

/// Blends the joints, if there are any, by one of the kernel's functions.
void blend_joints(void (*KernelTable::*how)(const BlendBlock& block), PoseState& pose, const PoseState& other,
                  float weight, std::span<const float> mask) {
    pose.stale.mark_all();
    if (pose.local.empty()) return;
    const KernelTable& kernels = kernel_table();
    const FlushDenormals flush(kernels.flushes_denormals);
    (kernels.*how)({pose.joint_count(), &pose.local.front().rotation[0][0], &other.local.front().rotation[0][0], weight,
                    mask.empty() ? nullptr : mask.data()});
}

}  // namespace

Result<void, CallError> blend(Pose& pose, const Pose& other, float weight, std::span<const float> mask) {
    if (const auto checked = check_blend(pose, other, weight, mask); !checked) return checked;
    const std::span<float> targets = pose.change_morph_weights();
    const std::span<const float> others = other.morph_weights();
    for (std::size_t k = 0; k < targets.size(); ++k) targets[k] = (1.0f - weight) * targets[k] + weight * others[k];
    blend_joints(&KernelTable::mix, PoseState::of(pose), PoseState::of(other), weight, mask);
    return {};
}

Result<void, CallError> make_additive(Pose& pose, const Pose& reference) {
    if (const auto checked = check_blend(pose, reference, 1.0f, {}); !checked) return checked;
    const std::span<float> targets = pose.change_morph_weights();
    const std::span<const float> others = reference.morph_weights();
    for (std::size_t k = 0; k < targets.size(); ++k) targets[k] -= others[k];
    PoseState& state = PoseState::of(pose);
    for (std::uint32_t joint = 0; joint < state.joint_count(); ++joint) {
        JointTransform to = state.local_of(joint);
        const JointTransform from = reference.local(joint);
        to.rotation = glm::normalize(glm::conjugate(glm::dquat(from.rotation)) * glm::dquat(to.rotation));
        to.translation -= from.translation;
        for (int c = 0; c < 3; ++c) to.scale[c] = from.scale[c] == 0.0f ? 1.0f : to.scale[c] / from.scale[c];
        state.set_local(joint, to);
    }
    return {};
}

Result<void, CallError> add(Pose& pose, const Pose& difference, float weight, std::span<const float> mask) {
    if (const auto checked = check_blend(pose, difference, weight, mask); !checked) return checked;
    const std::span<float> targets = pose.change_morph_weights();
    const std::span<const float> others = difference.morph_weights();
    for (std::size_t k = 0; k < targets.size(); ++k) targets[k] += weight * others[k];
    blend_joints(&KernelTable::add, PoseState::of(pose), PoseState::of(difference), weight, mask);
    return {};
}

std::vector<float> mask_below(const Model& model, std::uint32_t joint, float inside, float outside) {
    std::vector<float> mask(model.joints().size(), outside);
    if (joint >= mask.size()) return mask;
    mask[joint] = inside;
    const std::span<const std::uint32_t> parents = model.parents();
    std::vector<bool> is_below(mask.size());
    is_below[joint] = true;
    for (std::size_t below = joint + std::size_t{1}; below < mask.size(); ++below) {  // parents come first
        const std::uint32_t parent = parents[below];
        is_below[below] = parent != kNone && is_below[parent];
        if (is_below[below]) mask[below] = inside;
    }
    return mask;
}

}  // namespace bendy
