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

BlendBlock block_of(PoseState& pose, const PoseState& other, float weight, std::span<const float> mask) {
    return {pose.joint_count(), &pose.local.front().rotation[0][0], &other.local.front().rotation[0][0], weight,
            mask.empty() ? nullptr : mask.data()};
}

/// Returns towards * weight + q * (1 - weight), along the shorter arc.
glm::dquat mix(const glm::dquat& q, const glm::dquat& towards, double weight) {
    const glm::dquat sum = q * (1.0 - weight) + towards * (glm::dot(q, towards) < 0.0 ? -weight : weight);
    return glm::normalize(sum);
}

void mix_plain(const BlendBlock& block, PoseState& pose, const PoseState& other) {
    for (std::uint32_t joint = 0; joint < block.joints; ++joint) {
        const double weight = double{block.weight} * (block.mask == nullptr ? 1.0f : block.mask[joint]);
        JointTransform to = pose.local_of(joint);
        const JointTransform from = other.local_of(joint);
        to.rotation = mix(glm::dquat(to.rotation), glm::dquat(from.rotation), weight);
        to.translation = (1.0 - weight) * glm::dvec3(to.translation) + weight * glm::dvec3(from.translation);
        to.scale = (1.0 - weight) * glm::dvec3(to.scale) + weight * glm::dvec3(from.scale);
        pose.set_local(joint, to);
    }
}

void add_plain(const BlendBlock& block, PoseState& pose, const PoseState& difference) {
    for (std::uint32_t joint = 0; joint < block.joints; ++joint) {
        const double weight = double{block.weight} * (block.mask == nullptr ? 1.0f : block.mask[joint]);
        JointTransform to = pose.local_of(joint);
        const JointTransform from = difference.local_of(joint);
        to.rotation = glm::dquat(to.rotation) * mix(glm::dquat(1, 0, 0, 0), glm::dquat(from.rotation), weight);
        to.translation = glm::dvec3(to.translation) + weight * glm::dvec3(from.translation);
        to.scale = glm::dvec3(to.scale) * ((1.0 - weight) + weight * glm::dvec3(from.scale));
        pose.set_local(joint, to);
    }
}

}  // namespace

Result<void, CallError> blend(Pose& pose, const Pose& other, float weight, std::span<const float> mask) {
    if (const auto checked = check_blend(pose, other, weight, mask); !checked) return checked;
    const std::span<float> targets = pose.change_morph_weights();
    const std::span<const float> others = other.morph_weights();
    for (std::size_t k = 0; k < targets.size(); ++k) targets[k] = (1.0f - weight) * targets[k] + weight * others[k];
    PoseState& state = PoseState::of(pose);
    state.stale.mark_all();
    if (state.local.empty()) return {};
    const BlendBlock block = block_of(state, PoseState::of(other), weight, mask);
    if (const KernelTable* kernels = kernel_table()) {
        const FlushDenormals flush;
        kernels->mix(block);
    } else {
        mix_plain(block, state, PoseState::of(other));
    }
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
    PoseState& state = PoseState::of(pose);
    state.stale.mark_all();
    if (state.local.empty()) return {};
    const BlendBlock block = block_of(state, PoseState::of(difference), weight, mask);
    if (const KernelTable* kernels = kernel_table()) {
        const FlushDenormals flush;
        kernels->add(block);
    } else {
        add_plain(block, state, PoseState::of(difference));
    }
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
