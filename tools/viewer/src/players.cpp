#include "players.h"

#include "overlay.h"

#include <bendy/runtime/blend.h>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>

#include <algorithm>
#include <cmath>

namespace bendy::viewer {
namespace {

double length_of(const Clip& clip) {
    return static_cast<double>(clip.end) - static_cast<double>(clip.start);
}

constexpr double kEase = 0.4;              // seconds from one mode to the next
constexpr double kPress = 1.0 / 15.0;      // a press counts as holding the key for so many seconds
constexpr double kPullEvery = 1.0 / 60.0;  // seconds from pull to pull
constexpr double kOtherWay = 0.8;          // seconds from the pose where it was stuck to the other pose
constexpr int kMostPulls = 30;             // in one step, however long it is

/// As seen in the picture: X to the right, Y up, Z towards the viewer.
glm::vec3 direction_of(DemoKey key) {
    switch (key) {
        case DemoKey::left:
            return {-1.0f, 0.0f, 0.0f};
        case DemoKey::right:
            return {1.0f, 0.0f, 0.0f};
        case DemoKey::up:
            return {0.0f, 1.0f, 0.0f};
        case DemoKey::down:
            return {0.0f, -1.0f, 0.0f};
        case DemoKey::page_up:
            return {0.0f, 0.0f, -1.0f};
        case DemoKey::page_down:
            return {0.0f, 0.0f, 1.0f};
        default:
            return glm::vec3(0.0f);
    }
}

const Clip* find_animation(const Model& model) {
    const Clip* wave = model.clip("Wave");
    return wave != nullptr || model.clips().empty() ? wave : model.clips().data();
}

glm::vec3 unit_vector(int number) {
    glm::vec3 axis(0.0f);
    axis[number] = 1.0f;
    return axis;
}

/// Returns the number of the axis nearest to a direction.
int nearest_axis(const glm::vec3& direction) {
    const glm::vec3 size = glm::abs(direction);
    if (size.y >= size.x && size.y >= size.z) return 1;
    return size.x >= size.z ? 0 : 2;
}

/// Returns the picture's right in the horizontal plane: bending depends on the viewer's yaw, not on the pitch.
glm::vec3 level_right(const glm::vec3& right) {
    const glm::vec3 level(right.x, 0.0f, right.z);
    const float length = glm::length(level);
    return length > 0.0f ? level / length : glm::vec3(1.0f, 0.0f, 0.0f);
}

glm::quat rotation_of(const glm::mat4& matrix) {
    glm::mat3 axes(matrix);
    for (int k = 0; k < 3; ++k) axes[k] = glm::normalize(axes[k]);
    return glm::quat_cast(axes);
}

}  // namespace

Player::Player(const Model& model)
    : clip(model.clips().empty() ? kNone : 0), model_(&model), pose_(model), mixed_in_(model), reached_(model) {
    update();
    for (const Chain& chain : model.chains()) {
        const bool has_target = chain.record.target != kNone;
        chains.push_back(
            {false, has_target ? glm::vec3(pose_.model_space()[chain.record.target][3]) : tip_of(chain, pose_)});
    }
}

double Player::length() const {
    if (clip >= model_->clips().size()) return 0.0;
    const double own = length_of(model_->clips()[clip]);
    if (other >= model_->clips().size()) return own;
    return own + (length_of(model_->clips()[other]) - own) * static_cast<double>(share);
}

void Player::sample_at_phase(std::uint32_t number, Pose& pose) const {
    const Clip& played = model_->clips()[number];
    (void)sample(pose, &played, played.start + phase * (played.end - played.start));
}

void Player::step(double seconds) {
    const double whole = length();
    if (is_playing && whole > 0.0) {
        const double next = static_cast<double>(phase) + seconds * static_cast<double>(speed) / whole;
        phase = static_cast<float>(next - std::floor(next));
    }
    update(seconds);
}

void Player::update(double seconds) {
    if (clip < model_->clips().size()) {
        sample_at_phase(clip, pose_);
        if (other < model_->clips().size()) {
            sample_at_phase(other, mixed_in_);
            (void)blend(pose_, mixed_in_, share);
        }
    } else {
        pose_.set_rest();
    }
    if (obeys_constraints) constrain(pose_);
    ReachOptions options;
    options.state = &reached_;
    options.seconds = static_cast<float>(seconds);
    for (const std::uint32_t number : model_->chain_order()) {
        const Chain& chain = model_->chains()[number];
        if (number < chains.size() && chains[number].is_on) {
            (void)reach(pose_, &chain, chains[number].target, options);
        } else {
            (void)reached_.forget(&chain);
        }
    }
}

Demo::Demo(const Model& model)
    : model_(&model),
      chain_(model.chains().data()),
      clip_(find_animation(model)),
      pose_(model),
      before_(model),
      other_way_(model) {
    start_ = glm::vec3(pose_.model_space()[chain_->record.start][3]);
    reach_ = 0.0f;
    glm::vec3 last = start_;
    is_link_.resize(model.joints().size());
    joint_bends_.assign(model.joints().size(), glm::quat(1.0f, 0.0f, 0.0f, 0.0f));
    links_ = links_of(model, *chain_);
    for (const std::uint32_t joint : links_) {
        is_link_[joint] = true;
        const glm::vec3 here(pose_.model_space()[joint][3]);
        reach_ += glm::length(here - last);
        last = here;
    }
    reach_ += glm::length(tip() - last);
    for (const glm::mat4& joint : pose_.model_space()) rest_turns_.push_back(rotation_of(joint));
    reach_ = std::max(reach_, 1e-3f);
    move_target(chain_->record.target != kNone ? glm::vec3(pose_.model_space()[chain_->record.target][3]) : tip());
    step(0.0);
}

glm::vec3 Demo::tip() {
    return tip_of(*chain_, pose_);
}

double Demo::violation() const {
    double worst = 0.0;
    for (std::uint32_t joint = 0; joint < model_->joints().size(); ++joint) {
        const Constraint* constraint = constraint_record_of(joint);
        if (constraint == nullptr) continue;
        const glm::dquat R =
            to_constraint_space(*constraint, model_->joints()[joint].rest.rotation, pose_.local(joint).rotation);
        worst = std::max(worst, bendy::violation(*constraint, R));
    }
    return worst;
}

const Constraint* Demo::constraint_record_of(std::uint32_t joint) const {
    return state_.inverse && is_link_[joint] ? model_->ik_constraint(joint) : model_->constraint(joint);
}

void Demo::hold_constraints() {
    for (std::uint32_t joint = 0; joint < model_->joints().size(); ++joint) {
        const Constraint* constraint = constraint_record_of(joint);
        if (constraint == nullptr) continue;
        const glm::quat& rest = model_->joints()[joint].rest.rotation;
        JointTransform local = pose_.local(joint);
        const glm::dquat R = to_constraint_space(*constraint, rest, local.rotation);
        const glm::dquat legal = clamp_rotation(*constraint, R);
        if (legal != R) local.rotation = from_constraint_space(*constraint, rest, legal);
        local.translation = clamp_translation(*constraint, model_->joints()[joint].rest, local.translation);
        pose_.set_local(joint, local);
    }
}

void Demo::set_mode(bool forward, bool inverse) {
    before_ = pose_;
    since_mode_ = 0.0;
    since_other_way_ = kOtherWay;
    pull_time_ = 0.0;
    state_.forward = forward;
    state_.inverse = inverse;
}

void Demo::press(DemoKey key) {
    switch (key) {
        case DemoKey::quit:
            state_.quits = true;
            break;
        case DemoKey::bones:
            state_.bones = !state_.bones;
            break;
        case DemoKey::forward:
            set_mode(!state_.forward, false);
            break;
        case DemoKey::inverse:
            set_mode(false, !state_.inverse);
            break;
        case DemoKey::pause:
            state_.paused = !state_.paused;
            break;
        case DemoKey::turntable:
            state_.turntable = !state_.turntable;
            break;
        case DemoKey::wireframe:
            state_.wireframe = !state_.wireframe;
            break;
        case DemoKey::help:
            state_.help = !state_.help;
            break;
        case DemoKey::next_joint:
            choose_joint(1);
            break;
        case DemoKey::previous_joint:
            choose_joint(-1);
            break;
        default:
            hold(key, kPress);
            break;
    }
}

void Demo::hold(DemoKey key, double seconds) {
    move(direction_of(key), static_cast<float>(std::clamp(seconds, 0.0, 1.0)));
}

void Demo::move(const glm::vec3& direction, float amount) {
    if (state_.inverse) {
        const glm::vec3 nearer = glm::cross(right_, up_);
        const glm::vec3 seen = direction.x * right_ + direction.y * up_ + direction.z * nearer;
        move_target(state_.target + seen * (0.6f * reach_ * amount));
    } else if (state_.forward && state_.joint != kNone) {
        bend_joint(direction, 1.5f * amount);
    } else if (state_.forward) {
        bend_all(direction, 1.5f * amount);
    }
}

void Demo::look_along(const glm::vec3& right, const glm::vec3& up) {
    right_ = right;
    up_ = up;
}

/// Selects the next one of: the whole chain, its first joint, ... its last joint.
void Demo::choose_joint(int step) {
    if (!state_.forward) set_mode(true, false);
    const auto at = static_cast<int>(std::find(links_.begin(), links_.end(), state_.joint) - links_.begin());
    const auto places = static_cast<int>(links_.size()) + 1;  // the last one: the whole chain
    const int next = (at + step + places) % places;
    state_.joint = next + 1 == places ? kNone : links_[static_cast<std::size_t>(next)];
}

/// The chain is upright: Left and Right bend it sideways, Up and Down away from and towards the viewer, PgUp and PgDn
/// twist it.
void Demo::bend_all(const glm::vec3& direction, float amount) {
    constexpr float kMost = 2.4f;
    const glm::vec3 right = level_right(right_);
    const glm::vec3 nearer = glm::cross(right, glm::vec3(0.0f, 1.0f, 0.0f));
    const glm::vec3 turn = direction.y * right + glm::vec3(0.0f, direction.z, 0.0f) - direction.x * nearer;
    state_.bend = glm::clamp(state_.bend + turn * amount, -kMost, kMost);
}

/// Like bend_all, but about the joint's own axes: Left and Right turn it about that axis perpendicular to its bone
/// which faces the viewer more, Up and Down about the other one.
void Demo::bend_joint(const glm::vec3& direction, float amount) {
    const std::uint32_t joint = state_.joint;
    const bool is_last = joint == chain_->record.effector;
    const auto& offset = chain_->record.tip_offset;
    const auto next = std::find(links_.begin(), links_.end(), joint) + 1;
    const glm::vec3 bone =
        is_last ? glm::vec3(offset[0], offset[1], offset[2]) : model_->joints()[*next].rest.translation;
    const int along = nearest_axis(bone);
    const glm::mat3 axes = glm::mat3_cast(rotation_of(pose_.model_space()[joint]));
    const glm::vec3 right = level_right(right_);
    const glm::vec3 nearer = glm::cross(right, glm::vec3(0.0f, 1.0f, 0.0f));
    int facing = (along + 1) % 3;
    int across = (along + 2) % 3;
    if (std::abs(glm::dot(axes[across], nearer)) > std::abs(glm::dot(axes[facing], nearer))) std::swap(facing, across);
    const auto signed_axis = [&](int axis, const glm::vec3& towards) {
        return glm::dot(axes[axis], towards) < 0.0f ? -unit_vector(axis) : unit_vector(axis);
    };
    const glm::vec3 turn = direction.y * signed_axis(across, right) - direction.x * signed_axis(facing, nearer) +
                           direction.z * signed_axis(along, axes * bone);
    const float length = glm::length(turn);
    if (!(length > 0.0f)) return;
    const glm::quat before = bent_with_all(joint);
    const glm::quat from = before * joint_bends_[joint];
    const auto turned = [&](float share) {
        return glm::normalize(from * glm::angleAxis(share * amount * length, turn / length));
    };
    float share = 1.0f;
    if (const Constraint* constraint = constraint_record_of(joint)) {
        // The joint stops at its limits and does not slide along them, so the opposite key takes effect at once.
        const auto excess = [&](float part) {
            const glm::quat& rest = model_->joints()[joint].rest.rotation;
            return bendy::violation(*constraint, to_constraint_space(*constraint, rest, turned(part)));
        };
        constexpr double kLegal = 1e-6;    // radians
        constexpr double kOutside = 1e-4;  // bending the whole chain may move it outside
        constexpr int kHalvings = 16;
        if (excess(1.0f) > kLegal && excess(0.0f) < kOutside) {
            float legal = 0.0f;
            for (int k = 0; k < kHalvings; ++k) {
                const float middle = 0.5f * (legal + share);
                (excess(middle) > kLegal ? share : legal) = middle;
            }
            share = legal;
        }
    }
    joint_bends_[joint] = glm::normalize(glm::conjugate(before) * turned(share));
}

/// Returns the joint's rotation from the bend of the whole chain.
glm::quat Demo::bent_with_all(std::uint32_t joint) const {
    const glm::quat& rest = model_->joints()[joint].rest.rotation;
    const glm::vec3 share = state_.bend / static_cast<float>(std::max(chain_->links, 1u));
    const float angle = glm::length(share);
    if (angle == 0.0f) return rest;
    return glm::normalize(rest * glm::angleAxis(angle, glm::conjugate(rest_turns_[joint]) * (share / angle)));
}

void Demo::move_target(const glm::vec3& position) {
    // The target may be slightly out of reach; the tentacle then points at it.
    const float farthest = 1.3f * reach_;
    const glm::vec3 away = position - start_;
    const float distance = glm::length(away);
    if (!std::isfinite(distance)) return;
    since_other_way_ = kOtherWay;
    still_ = 0;
    has_looked_ = false;
    state_.target = distance > farthest ? start_ + away * (farthest / distance) : position;
}

void Demo::drag_target(const glm::vec3& position) {
    if (!state_.inverse) set_mode(false, true);
    move_target(position);
}

void Demo::pose_by_hand() {
    pose_.set_rest();
    for (const std::uint32_t joint : links_) {
        JointTransform local = pose_.local(joint);
        local.rotation = glm::normalize(bent_with_all(joint) * joint_bends_[joint]);
        pose_.set_local(joint, local);
    }
}

void Demo::pull() {
    ReachOptions options;
    options.solver = Solver::pull;
    options.iterations = 1;
    const int pulls = std::min(kMostPulls, static_cast<int>(pull_time_ / kPullEvery));
    pull_time_ -= pulls * kPullEvery;
    if (pulls == kMostPulls) pull_time_ = 0.0;
    for (int k = 0; k < pulls; ++k) {
        const auto reached = reach(pose_, chain_, state_.target, options);
        const float distance = reached ? reached->distance : 0.0f;
        constexpr float kProgress = 2e-4f;  // of the chain's length
        still_ = last_distance_ - distance > kProgress * reach_ ? 0 : still_ + 1;
        last_distance_ = distance;
    }
    look_for_another_way(last_distance_);
}

void Demo::look_for_another_way(float distance) {
    constexpr int kStill = 20;
    constexpr float kNear = 5e-3f;   // of the chain's length
    constexpr float kBetter = 0.7f;  // of the remaining distance
    if (has_looked_ || still_ < kStill || distance < kNear * reach_) return;
    has_looked_ = true;
    other_way_ = pose_;
    ReachOptions options;
    options.solver = Solver::least_squares;
    const auto reached = reach(other_way_, chain_, state_.target, options);
    if (reached && reached->distance > kBetter * distance) return;
    before_ = pose_;
    since_other_way_ = 0.0;
}

void Demo::step(double seconds) {
    if (!(seconds >= 0.0)) return;
    since_mode_ += seconds;
    if (state_.turntable) state_.angle = std::remainder(state_.angle + 0.8 * seconds, 6.283185307179586);
    if (state_.inverse) {
        // The pull starts from the current pose and takes several frames to reach the target.
        since_other_way_ += seconds;
        if (since_other_way_ < kOtherWay) {
            const double share = since_other_way_ / kOtherWay;
            pose_ = before_;
            (void)blend(pose_, other_way_, static_cast<float>(share * share * (3.0 - 2.0 * share)));
        } else {
            pull_time_ += seconds;
            pull();
        }
    } else {
        if (state_.forward) {
            pose_by_hand();
        } else if (clip_ != nullptr) {
            if (!state_.paused) state_.time += seconds;
            const double length = std::max(static_cast<double>(clip_->end) - static_cast<double>(clip_->start), 1e-3);
            state_.time = std::fmod(state_.time, length);
            (void)sample(pose_, clip_, clip_->start + static_cast<float>(state_.time));
        }
        if (since_mode_ < kEase) (void)blend(pose_, before_, static_cast<float>(1.0 - since_mode_ / kEase));
    }
    hold_constraints();
}

}  // namespace bendy::viewer
