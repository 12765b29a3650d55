#include <bendy/runtime/pose.h>

#include "pose_state.h"

#include <algorithm>
#include <cassert>

namespace bendy {

PoseState::PoseState(const Model& from)
    : model(from),
      data(&ModelData::of(model)),
      morph_weights(from.morph_target_count()),
      active_targets(data->most_targets),
      ik_links(std::max(data->longest_chain, kLimbLinks)),
      palette(std::max(data->largest_palette, 1u)) {
    data->make_plans();
    is_exact = !data->pose_plan->fits_floats;
    if (is_exact) exact_model_space.resize(data->joints.size());
    local.resize(data->pose_plan->rest.size());
    timed_keys.resize(data->pose_plan->most_timed);
    model_space.resize(local.size() * JointBlock::kJoints);
    set_rest();
    refresh();
}

void PoseState::set_start(std::span<const JointBlock> from) {
    stale.mark_all();
    std::copy_n(from.data(), from.size(), local.data());
    std::copy(data->pose_plan->rest_weights.begin(), data->pose_plan->rest_weights.end(), morph_weights.begin());
}

Pose::Pose(const Model& model) : state_(std::make_unique<PoseState>(model)) {}

Pose::Pose(const Pose& other) : state_(std::make_unique<PoseState>(*other.state_)) {}

Pose::Pose(Pose&& other) noexcept = default;

Pose& Pose::operator=(const Pose& other) {
    if (this == &other) return *this;
    if (state_) {
        *state_ = *other.state_;  // does not allocate if both are of one model
    } else {
        state_ = std::make_unique<PoseState>(*other.state_);
    }
    return *this;
}

Pose& Pose::operator=(Pose&& other) noexcept = default;

Pose::~Pose() = default;

void Pose::set_rest() {
    state_->set_rest();
}

const Model& Pose::model() const {
    return state_->model;
}

JointTransform Pose::local(std::uint32_t joint) const {
    assert(joint < state_->joint_count());
    return joint < state_->joint_count() ? state_->local_of(joint) : JointTransform{};
}

void Pose::set_local(std::uint32_t joint, const JointTransform& transform) {
    assert(joint < state_->joint_count());
    if (joint < state_->joint_count()) state_->set_local(joint, transform);
}

std::span<const JointBlock> Pose::local_blocks() const {
    return state_->local;
}

std::span<JointBlock> Pose::change_local_blocks() {
    state_->stale.mark_all();
    return state_->local;
}

std::span<const float> Pose::morph_weights() const {
    return state_->morph_weights;
}

std::span<float> Pose::change_morph_weights() {
    return state_->morph_weights;
}

std::span<const glm::mat4> Pose::model_space() {
    state_->refresh();
    if (state_->model_space.empty()) return {};
    return {&state_->model_space.front().matrix, state_->joint_count()};
}

std::span<const PaletteMatrix> Pose::palette(std::uint32_t mesh) {
    if (mesh >= state_->data->object.meshes.size()) return {};
    state_->refresh();
    state_->make_palette(mesh);
    return std::span(state_->palette).first(state_->data->object.meshes[mesh].palette.joints.size());
}

}  // namespace bendy
