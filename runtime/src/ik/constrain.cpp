#include <bendy/runtime/constrain.h>

#include "constrain_joint.h"
#include "math/nearest_rotation.h"
#include "math/rotation.h"

#include <algorithm>

namespace bendy {
namespace {

/// Radians: tolerance for a legal rotation that was rounded to floats.
constexpr double kRounding = 1e-6;

}  // namespace

glm::dquat clamp_rotation(const Constraint& constraint, const glm::dquat& R) {
    return nearest_rotation(constraint, constraint.shape, R);
}

double violation(const Constraint& constraint, const glm::dquat& R) {
    return angle_between(clamp_rotation(constraint, R), R);
}

glm::dquat to_constraint_space(const Constraint& constraint, const glm::quat& rest, const glm::quat& local) {
    const glm::dquat relative = glm::conjugate(glm::dquat(rest)) * glm::dquat(local);
    return glm::normalize(glm::conjugate(constraint.frame) * relative * constraint.frame);
}

glm::quat from_constraint_space(const Constraint& constraint, const glm::quat& rest, const glm::dquat& R) {
    const glm::dquat relative = constraint.frame * R * glm::conjugate(constraint.frame);
    const glm::dquat local = glm::normalize(glm::dquat(rest) * relative);
    return {static_cast<float>(local.w), static_cast<float>(local.x), static_cast<float>(local.y),
            static_cast<float>(local.z)};
}

glm::vec3 clamp_translation(const Constraint& constraint, const JointTransform& rest, const glm::vec3& translation) {
    const glm::dquat axes = glm::normalize(glm::dquat(rest.rotation)) * constraint.frame;
    const glm::dvec3 d = glm::conjugate(axes) * (glm::dvec3(translation) - glm::dvec3(rest.translation));
    glm::dvec3 legal = d;
    for (int axis = 0; axis < 3; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        const double low = constraint.record.translation_min[i];
        const double high = constraint.record.translation_max[i];
        if (low <= high) legal[axis] = std::clamp(d[axis], low, high);  // false for NaN
    }
    return legal == d ? translation : glm::vec3(glm::dvec3(rest.translation) + axes * legal);
}

double constrain_joint(Pose& pose, const Constraint& constraint, Legal which) {
    const JointTransform& rest = pose.model().joints()[constraint.joint].rest;
    JointTransform joint = pose.local(constraint.joint);
    const glm::dquat R = to_constraint_space(constraint, rest.rotation, joint.rotation);
    const glm::dquat legal =
        which == Legal::nearest ? clamp_rotation(constraint, R) : quick_legal_rotation(constraint, constraint.shape, R);
    const double angle = angle_between(legal, R);
    const bool is_outside = angle > kRounding;
    if (is_outside) joint.rotation = from_constraint_space(constraint, rest.rotation, legal);
    if (constraint.limits_translation) joint.translation = clamp_translation(constraint, rest, joint.translation);
    if (is_outside || constraint.limits_translation) pose.set_local(constraint.joint, joint);
    return is_outside ? angle : 0.0;
}

void constrain(Pose& pose) {
    const Model& model = pose.model();
    for (const Constraint& constraint : model.constraints()) {
        if (model.constraint(constraint.joint) == &constraint) constrain_joint(pose, constraint, Legal::nearest);
    }
}

}  // namespace bendy
