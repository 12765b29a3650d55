#include <bendy/runtime/root_motion.h>

#include <bendy/runtime/sample.h>

#include "math/rigid_part.h"
#include "math/rotation.h"
#include "model/model_data.h"
#include "unpack.h"

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace bendy {
namespace {

/// Returns the part of a rotation about the y axis.
glm::dquat yaw_of(const glm::dquat& rotation) {
    const double length = std::sqrt(rotation.w * rotation.w + rotation.y * rotation.y);
    constexpr double kUpsideDown = 1e-9;
    if (!(length > kUpsideDown)) return {1.0, 0.0, 0.0, 0.0};
    return {rotation.w / length, 0.0, rotation.y / length, 0.0};
}

void set(const TrackView& track, std::span<const float> value, JointTransform& joint) {
    if (track.path == TrackPath::translation) joint.translation = {value[0], value[1], value[2]};
    if (track.path == TrackPath::rotation) joint.rotation = glm::quat(value[3], value[0], value[1], value[2]);
    if (track.path == TrackPath::scale) joint.scale = {value[0], value[1], value[2]};
}

/// Samples a single joint, as `sample` does.
JointTransform sample_joint(const Model& model, const Clip& clip, std::uint32_t joint, float seconds) {
    JointTransform local = model.joints()[joint].rest;
    for (const TrackView& track : clip.tracks) {
        if (track.path == TrackPath::weights || track.target != joint) continue;
        std::array<float, 4> value{};
        const auto used = std::span(value).first(track.components);
        sample_track(track, clip, seconds, used);
        set(track, used, local);
    }
    if (!clip.packed) return local;
    const PackedView& packed = *clip.packed;
    const bool is_animated = packed.animates(joint, TrackPath::rotation) ||
                             packed.animates(joint, TrackPath::translation) || packed.animates(joint, TrackPath::scale);
    if (!is_animated) return local;
    const PackedMoment moment = packed_moment(packed, seconds);
    PackedGroupReader reader(packed, moment.frame);
    for (PackedGroup group; reader.next(group);) {
        for (std::uint32_t track = 0; track < group.count; ++track) {
            if (group.joints.at(track) == joint) set_unpacked(group, track, moment.fraction, local);
        }
    }
    return local;
}

}  // namespace

glm::dmat4 RootMotion::matrix() const {
    glm::dmat4 matrix(glm::mat3_cast(rotation));
    matrix[3] = glm::dvec4(translation, 1.0);
    return matrix;
}

RootMotion compose(const RootMotion& before, const RootMotion& motion) {
    return {before.translation + before.rotation * motion.translation,
            glm::normalize(before.rotation * motion.rotation)};
}

RootMotion inverse(const RootMotion& motion) {
    const glm::dquat back = glm::conjugate(motion.rotation);
    return {back * -motion.translation, back};
}

RootMotion blend(const RootMotion& motion, const RootMotion& other, double weight) {
    return {motion.translation + weight * (other.translation - motion.translation),
            between(motion.rotation, other.rotation, weight)};
}

RootMotion repeat(const RootMotion& motion, std::uint64_t times) {
    RootMotion all;
    RootMotion power = motion;  // motion applied 1, 2, 4, ... times
    for (; times != 0; times >>= 1u) {
        if (times % 2 == 1) all = compose(all, power);
        power = compose(power, power);
    }
    return all;
}

RootPath::RootPath(const Model& model, std::uint32_t joint, const RootAxes& axes)
    : model_(model), axes_(axes), chosen_(axes.x ? 1.0 : 0.0, axes.y ? 1.0 : 0.0, axes.z ? 1.0 : 0.0) {
    if (joint >= model.joints().size()) return;
    for (std::uint32_t at = joint; at != kNone; at = model.parents()[at]) path_.push_back(at);
    std::reverse(path_.begin(), path_.end());
    glm::dmat4 rest(1.0);
    for (const std::uint32_t at : path_) rest *= to_matrix(model.joints()[at].rest, model.joints()[at].shear);
    rest_position_ = glm::dvec3(rest[3]);
    rest_rotation_ = rigid_rotation(rest);
}

RootMotion RootPath::motion_of(const glm::dmat4& root) const {
    RootMotion motion;
    if (axes_.turn != RootTurn::none) {
        motion.rotation = glm::normalize(rigid_rotation(root) * glm::conjugate(rest_rotation_));
        if (axes_.turn == RootTurn::yaw) motion.rotation = yaw_of(motion.rotation);
    }
    // Chosen so that undoing the motion resets the chosen components of the position to those at rest.
    motion.translation = chosen_ * glm::dvec3(root[3]) - motion.rotation * (chosen_ * rest_position_);
    return motion;
}

RootMotion RootPath::motion_at(const Clip& clip, double seconds) const {
    if (path_.empty() || std::isnan(seconds)) return {};
    glm::dmat4 root(1.0);
    for (const std::uint32_t joint : path_) {
        const JointTransform local = sample_joint(model_, clip, joint, static_cast<float>(seconds));
        root *= to_matrix(local, model_.joints()[joint].shear);
    }
    return motion_of(root);
}

RootMotion RootPath::motion_between(const Clip& clip, double from, double to) const {
    return compose(inverse(motion_at(clip, from)), motion_at(clip, to));
}

RootMotion RootPath::along(const Clip& clip, const TimeSpan& span) const {
    return span.from == span.to ? RootMotion{} : motion_between(clip, span.from, span.to);
}

Result<RootMotion, CallError> RootPath::at(const Clip& clip, double seconds) const {
    if (const auto checked = ModelData::of(model_).check(&clip); !checked) return checked.error();
    return motion_at(clip, seconds);
}

Result<RootMotion, CallError> RootPath::between(const Clip& clip, double from, double to) const {
    if (const auto checked = ModelData::of(model_).check(&clip); !checked) return checked.error();
    return motion_between(clip, from, to);
}

Result<RootMotion, CallError> RootPath::over(const Clip& clip, const PlayedInterval& played) const {
    if (const auto checked = ModelData::of(model_).check(&clip); !checked) return checked.error();
    RootMotion all = along(clip, played.first);
    if (played.turns) {  // forwards and backwards cancel
        if (played.passes % 2 == 1) all = compose(all, along(clip, played.pass));
    } else if (played.passes != 0) {
        all = compose(all, repeat(along(clip, played.pass), played.passes));
    }
    return compose(all, along(clip, played.last));
}

Result<RootMotion, CallError> RootPath::extract(Pose& pose) const {
    if (pose.model() != model_) return CallError::other_model;
    if (path_.empty()) return RootMotion{};
    const auto joints = model_.joints();
    glm::dmat4 above(1.0);
    for (std::size_t k = 0; k + 1 < path_.size(); ++k) above *= to_matrix(pose.local(path_[k]), joints[path_[k]].shear);
    const std::uint32_t joint = path_.back();
    const glm::dmat4 root = above * to_matrix(pose.local(joint), joints[joint].shear);
    if (!(std::abs(glm::determinant(glm::dmat3(above))) > 0.0)) return RootMotion{};
    const RootMotion motion = motion_of(root);
    const RootMotion back = inverse(motion);
    const glm::dquat turn = rigid_rotation(above);
    JointTransform local = pose.local(joint);
    const glm::dvec3 to = back.translation + back.rotation * glm::dvec3(root[3]);
    local.translation = glm::dvec3(glm::inverse(above) * glm::dvec4(to, 1.0));
    local.rotation = glm::normalize(glm::conjugate(turn) * back.rotation * turn * glm::dquat(local.rotation));
    pose.set_local(joint, local);
    return motion;
}

}  // namespace bendy
