#include <bendy/motion/stand.h>

#include <bendy/edit/edit.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/standing_pose.h>
#include <bendy/format/trig.h>
#include <bendy/runtime.h>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace bendy::motion {
namespace {

using edit::Edited;
using edit::Problem;

/// The product of the rotations from the root to each joint.
std::vector<glm::dquat> turns_of(Pose& pose) {
    const auto parents = pose.model().parents();
    std::vector<glm::dquat> turns;
    turns.reserve(parents.size());
    for (std::uint32_t joint = 0; joint < parents.size(); ++joint) {
        const glm::dquat own = glm::normalize(glm::dquat(pose.local(joint).rotation));
        turns.push_back(parents[joint] == kNone ? own : turns[parents[joint]] * own);
    }
    return turns;
}

/// 1 for the left of the pairs that say where left is, -1 for the right.
double side_of(Role role) {
    constexpr std::array kLeft{Role::left_upper_leg, Role::left_upper_arm, Role::left_hind_leg, Role::left_front_leg};
    constexpr std::array kRight{Role::right_upper_leg, Role::right_upper_arm, Role::right_hind_leg,
                                Role::right_front_leg};
    const auto is_in = [role](const auto& roles) { return std::find(roles.begin(), roles.end(), role) != roles.end(); };
    return is_in(kLeft) ? 1.0 : is_in(kRight) ? -1.0 : 0.0;
}

/// Measures a body that stands with Y up; nothing if left is not known.
std::optional<StandingPoseRecord> measure(const Model& model) {
    Pose pose(model);
    (void)stand(pose);
    const auto joints = pose.model_space();
    glm::dvec3 across(0.0);
    double lowest = std::numeric_limits<double>::infinity();
    double highest = -lowest;
    for (const JointRole& role : model.roles()) {
        const glm::dvec3 place(joints[role.joint][3]);
        lowest = std::min(lowest, place.y);
        highest = std::max(highest, place.y);
        across += side_of(static_cast<Role>(role.role)) * place;
    }
    const glm::dvec3 left(across.x, 0.0, across.z);
    const double length = glm::length(left);
    if (!(length > 1e-6 * (highest - lowest)) || !std::isfinite(highest - lowest + length)) return std::nullopt;
    const glm::dvec3 x = left / length;
    const glm::dvec3 up(0.0, 1.0, 0.0);
    const glm::quat axes(glm::normalize(glm::quat_cast(glm::dmat3(x, up, glm::cross(x, up)))));
    StandingPoseRecord record;
    record.axes = {axes.x, axes.y, axes.z, axes.w};
    record.ground = static_cast<float>(lowest);
    record.height = static_cast<float>(highest - lowest);
    return record;
}

/// By how many radians about Y the body is turned from +Z; 0 up to 20 degrees.
double heading_of(const StandingPoseRecord& record) {
    constexpr double kStraight = 0.35;  // radians
    const auto& [x, y, z, w] = record.axes;
    const glm::dvec3 front(glm::quat(w, x, y, z) * glm::vec3(0.0f, 0.0f, 1.0f));
    const double angle = trig::atan2(front.x, front.z);
    return std::abs(angle) < kStraight ? 0.0 : angle;
}

/// Joints with a role turned like this, in model space.
class Turned {
public:
    void add(std::uint32_t joint, const glm::dquat& turn) {
        const glm::quat own(glm::normalize(turn));
        rotations_.push_back(standing_rotation(joint, {own.x, own.y, own.z, own.w}));
        turns_.push_back(turn);
    }

    /// The file with them. It is measured as a reader will understand it.
    [[nodiscard]] Edited write(Bytes file, edit::Log& log) const {
        const auto record = measured(file);
        if (!record) return record.error();
        log.done.push_back("the body stands as told, " + std::to_string(rotations_.size()) + " joints turned");
        return edit::set_standing_pose(file, *record, rotations_);
    }

    /// As write, but turned about the vertical so that the body faces Z.
    [[nodiscard]] Edited write_to_front(Bytes file, edit::Log& log) const {
        const auto record = measured(file);
        if (!record) return record.error();
        const trig::SinCos half = trig::sin_cos(-0.5 * heading_of(*record));
        const glm::dquat to_front(half.cos, 0.0, half.sin, 0.0);
        Turned front;
        for (std::size_t k = 0; k < turns_.size(); ++k) front.add(rotations_[k].joint, to_front * turns_[k]);
        return front.write(file, log);
    }

private:
    [[nodiscard]] Result<StandingPoseRecord, Problem> measured(Bytes file) const {
        const Edited turned = edit::set_standing_pose(file, {}, rotations_);
        if (!turned) return turned.error();
        const Result<Model> model = Model::from_memory(*turned);
        const std::optional<StandingPoseRecord> record = model ? measure(*model) : std::nullopt;
        if (!record) return Problem{"hips, shoulders or legs do not say where left is: --role says what joints are"};
        return *record;
    }

    std::vector<StandingRotationRecord> rotations_;
    std::vector<glm::dquat> turns_;  // the same
};

Result<Model, Problem> open_body(Bytes file) {
    Result<Model> model = Model::from_memory(file);
    if (!model) return Problem{std::string(describe(model.error()))};
    if (model->roles().empty()) return Problem{"no joint has a role: --role says what the joints are"};
    return *std::move(model);
}

}  // namespace

Edited stand_as_in_clip(Bytes file, const std::string& clip, double seconds, edit::Log& log) {
    const auto model = open_body(file);
    if (!model) return model.error();
    std::vector<std::string_view> names;
    for (const Clip& one : model->clips()) names.push_back(one.name);
    const auto found = edit::find_named(names, clip, "clip");
    if (!found) return found.error();
    const Clip& which = model->clips()[found->front()];
    if (!(seconds >= which.start && seconds <= which.end)) {
        return Problem{"clip \"" + std::string(which.name) + "\" is from " + std::to_string(which.start) + " to " +
                       std::to_string(which.end) + " s"};
    }
    Pose pose(*model);
    (void)sample(pose, &which, static_cast<float>(seconds));
    const std::vector<glm::dquat> turns = turns_of(pose);
    Turned turned;
    for (const JointRole& role : model->roles()) turned.add(role.joint, turns[role.joint]);
    return turned.write_to_front(file, log);
}

Edited stand_as(Bytes file, Bytes other, edit::Log& log) {
    const auto model = open_body(file);
    if (!model) return model.error();
    const Result<Model> there = Model::from_memory(other);
    if (!there) return Problem{std::string(describe(there.error()))};
    Pose rest(*there);
    const std::vector<glm::dquat> turns = turns_of(rest);
    Turned turned;
    for (const JointRole& role : model->roles()) {
        const std::string_view name = model->joints()[role.joint].name;
        const std::uint32_t joint = there->joint(name);
        if (joint == kNone) return Problem{"it has no joint \"" + std::string(name) + '"'};
        turned.add(role.joint, turns[joint]);
    }
    return turned.write(file, log);
}

double facing(const Model& model) {
    const std::optional<StandingPoseRecord> record = measure(model);
    return record ? heading_of(*record) : 0.0;
}

}  // namespace bendy::motion
