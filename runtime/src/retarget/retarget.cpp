#include <bendy/runtime/retarget.h>

#include "retarget_plan.h"
#include "settle.h"
#include "slow_down.h"

#include "math/rotation.h"
#include "pose/pose_state.h"

#include <glm/matrix.hpp>

#include <cassert>
#include <cmath>
#include <cstddef>
#include <utility>

namespace bendy {
namespace {

void find_turns(RetargetPlan& plan, const PoseState& source) {
    std::size_t turn = 0;
    for (const SourceJoint& joint : plan.source_joints) {  // parents come first
        const glm::quat local = source.local_of(joint.joint).rotation;
        glm::dquat found = joint.above == kNone ? glm::dquat(local) : plan.turns[joint.above] * glm::dquat(local);
        if (joint.mirrors) found = found * joint.flip;
        plan.turns[turn++] = found;
    }
    for (const MixedTurn& mix : plan.mixed_turns) {
        const glm::dquat a = glm::normalize(plan.turns[mix.a] * mix.rest_a);
        const glm::dquat b = glm::normalize(plan.turns[mix.b] * mix.rest_b);
        plan.turns[turn++] = between(a, b, mix.share);
    }
}

/// Moves a prop from rest as the source's has moved.
void carry_prop(const MovedJoint& moved, const JointTransform& source, const JointTransform& source_rest,
                JointTransform& local) {
    const glm::dvec3 travelled(source.translation - source_rest.translation);
    local.translation += glm::vec3(moved.travel * travelled);
    for (int axis = 0; axis < 3; ++axis) {
        if (source_rest.scale[axis] != 0.0f) local.scale[axis] *= source.scale[axis] / source_rest.scale[axis];
    }
}

void turn_joints(const RetargetPlan& plan, const PoseState& source, PoseState& target) {
    for (const StandingJoint& standing : plan.standing) target.set_rotation(standing.joint, standing.rotation);
    for (const MovedJoint& moved : plan.moved) {
        if (moved.is_copy) {
            target.set_local(moved.joint, source.local_of(moved.source));
            continue;
        }
        const glm::dquat turn = plan.turns[moved.turn] * moved.after;
        const glm::dquat local =
            moved.before * (moved.above == kNone ? turn : glm::conjugate(plan.turns[moved.above]) * turn);
        target.set_rotation(moved.joint, glm::quat(glm::normalize(local)));
        if (!moved.is_prop) continue;
        JointTransform transform = target.local_of(moved.joint);
        carry_prop(moved, source.local_of(moved.source), source.data->joints[moved.source].rest, transform);
        target.set_local(moved.joint, transform);
    }
}

/// Returns false if a number is not finite.
bool move_hips(const RetargetPlan& plan, PoseState& source, PoseState& target) {
    const HipsPlan& hips = plan.hips;
    if (hips.joint == kNone) return true;
    const glm::dvec3 middle =
        0.5 * (glm::dvec3(source.fresh_matrix(hips.source[0])[3]) + glm::dvec3(source.fresh_matrix(hips.source[1])[3]));
    glm::dmat4 above(1.0);
    for (const std::uint32_t joint : hips.above)
        above = above * to_matrix(target.local_of(joint), target.data->joints[joint].shear);
    JointTransform local = target.local_of(hips.joint);
    local.translation = glm::vec3(0.0f);
    const glm::dmat4 own = to_matrix(local, target.data->joints[hips.joint].shear);
    const glm::dvec3 place(glm::inverse(above) * glm::dvec4(plan.map(middle), 1.0));
    const glm::dvec3 moved = place - glm::dvec3(own * glm::dvec4(hips.middle, 1.0));
    if (!std::isfinite(moved.x + moved.y + moved.z)) return false;
    local.translation = glm::vec3(moved);
    target.set_local(hips.joint, local);
    return true;
}

void set_morph_targets(const RetargetPlan& plan, const PoseState& source, PoseState& target) {
    for (std::size_t to = 0; to < plan.morph_targets.size(); ++to) {
        if (plan.morph_targets[to] != kNone) target.morph_weights[to] = source.morph_weights[plan.morph_targets[to]];
    }
}

bool are_finite(const RetargetPlan& plan) {
    double sum = 0.0;
    for (const glm::dquat& turn : plan.turns) sum += 0.0 * (turn.x + turn.y + turn.z + turn.w);
    return sum == 0.0;
}

}  // namespace

Retarget::Retarget(std::unique_ptr<RetargetPlan> plan) : plan_(std::move(plan)) {}
Retarget::Retarget(const Retarget& other) : plan_(std::make_unique<RetargetPlan>(*other.plan_)) {}
Retarget::Retarget(Retarget&& other) noexcept = default;
Retarget& Retarget::operator=(const Retarget& other) {
    if (this != &other) plan_ = std::make_unique<RetargetPlan>(*other.plan_);
    return *this;
}
Retarget& Retarget::operator=(Retarget&& other) noexcept = default;
Retarget::~Retarget() = default;

const Model& Retarget::source() const {
    return plan_->source;
}

const Model& Retarget::target() const {
    return plan_->target;
}

const glm::dquat& Retarget::turn() const {
    return plan_->map.turn;
}

float Retarget::scale() const {
    return static_cast<float>(plan_->map.scale);
}

float Retarget::leg() const {
    return static_cast<float>(plan_->leg);
}

std::span<const std::uint32_t> Retarget::joints() const {
    return plan_->joints;
}

std::span<const std::uint32_t> Retarget::morph_targets() const {
    return plan_->morph_targets;
}

Result<Retargeted, CallError> retarget(Pose& pose, Retarget& retarget, Pose& source, RetargetState& state,
                                       const std::optional<ContactWeights>& contacts, float seconds) {
    RetargetPlan& plan = RetargetPlan::of(retarget);
    if (pose.model() != plan.target || source.model() != plan.source) return CallError::other_model;
    assert(&pose != &source);
    PoseState& from = PoseState::of(source);
    PoseState& to = PoseState::of(pose);
    to.set_rest();
    find_turns(plan, from);
    if (!are_finite(plan)) return CallError::not_finite;
    turn_joints(plan, from, to);
    if (!move_hips(plan, from, to)) {
        to.set_rest();
        return CallError::not_finite;
    }
    place_detached(plan, to);
    set_morph_targets(plan, from, to);
    const Retargeted retargeted = settle(plan, source, pose, state, contacts);
    slow_down(plan, from, to, state, seconds);
    return retargeted;
}

}  // namespace bendy
