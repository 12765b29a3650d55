#include "body.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace bendy {
namespace {

constexpr Role kNeeded[] = {Role::hips,
                            Role::head,
                            Role::left_upper_leg,
                            Role::left_lower_leg,
                            Role::left_foot,
                            Role::right_upper_leg,
                            Role::right_lower_leg,
                            Role::right_foot,
                            Role::left_upper_arm,
                            Role::left_lower_arm,
                            Role::left_hand,
                            Role::right_upper_arm,
                            Role::right_lower_arm,
                            Role::right_hand};

/// Returns the coordinate axis nearest to a unit vector if it is within the angle; otherwise the vector.
glm::dvec3 snapped(const glm::dvec3& v, double cosine) {
    for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(v[axis]) < cosine) continue;
        glm::dvec3 exact(0.0);
        exact[axis] = v[axis] < 0.0 ? -1.0 : 1.0;
        return exact;
    }
    return v;
}

double distance(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::length(b - a);
}

}  // namespace

Body::Body(const Model& model)
    : model_(model), by_role_(static_cast<std::size_t>(Role::spine_chain), kNone), has_role_(model.joints().size()) {
    for (const JointRole& role : model.roles()) {
        has_role_[role.joint] = true;
        if (role.role < by_role_.size()) by_role_[role.role] = role.joint;
    }
    const auto joints = model.joints();
    rest_.reserve(joints.size());
    turns_.reserve(joints.size());
    for (const Joint& joint : joints) {  // parents come first
        const glm::dmat4 local = to_matrix(joint.rest, joint.shear);
        rest_.push_back(joint.parent == kNone ? local : rest_[joint.parent] * local);
        turns_.push_back(space(joint.parent) * glm::normalize(glm::dquat(joint.rest.rotation)));
    }
}

std::uint32_t Body::joint(Role role) const {
    return by_role_[static_cast<std::size_t>(role)];
}

std::vector<std::uint32_t> Body::joints(std::initializer_list<Role> roles) const {
    std::vector<std::uint32_t> found;
    for (const Role role : roles) {
        if (joint(role) != kNone) found.push_back(joint(role));
    }
    return found;
}

std::vector<std::uint32_t> Body::chain(Role role) const {
    std::vector<JointRole> found;
    for (const JointRole& one : model_.roles()) {
        if (static_cast<Role>(one.role) == role) found.push_back(one);
    }
    std::sort(found.begin(), found.end(), [](const JointRole& a, const JointRole& b) { return a.place < b.place; });
    std::vector<std::uint32_t> joints;
    joints.reserve(found.size());
    for (const JointRole& one : found) joints.push_back(one.joint);
    return joints;
}

std::vector<Role> Body::missing() const {
    std::vector<Role> missing;
    for (const Role role : kNeeded) {
        if (joint(role) == kNone) missing.push_back(role);
    }
    return missing;
}

glm::dquat Body::flip(std::uint32_t joint) const {
    const glm::vec3& scale = model_.joints()[joint].rest.scale;
    glm::dvec3 signs(scale.x < 0.0f ? -1.0 : 1.0, scale.y < 0.0f ? -1.0 : 1.0, scale.z < 0.0f ? -1.0 : 1.0);
    signs *=
        signs.x * signs.y * signs.z;  // a mirror is a half turn and a point reflection, which leaves turns as they are
    if (signs == glm::dvec3(1.0)) return {1.0, 0.0, 0.0, 0.0};
    return {0.0, signs.x > 0.0 ? 1.0 : 0.0, signs.y > 0.0 ? 1.0 : 0.0, signs.z > 0.0 ? 1.0 : 0.0};
}

glm::dquat Body::space(std::uint32_t joint) const {
    return joint == kNone ? glm::dquat(1.0, 0.0, 0.0, 0.0) : turns_[joint] * flip(joint);
}

bool Body::measure() {
    const glm::dvec3 hips = 0.5 * (place(Role::left_upper_leg) + place(Role::right_upper_leg));
    const glm::dvec3 feet = 0.5 * (place(Role::left_foot) + place(Role::right_foot));
    const glm::dvec3 across = place(Role::left_upper_leg) - place(Role::right_upper_leg) + place(Role::left_upper_arm) -
                              place(Role::right_upper_arm);
    const glm::dvec3 along = place(Role::head) - feet;
    leg_ = 0.5 * (distance(place(Role::left_upper_leg), place(Role::left_lower_leg)) +
                  distance(place(Role::left_lower_leg), place(Role::left_foot)) +
                  distance(place(Role::right_upper_leg), place(Role::right_lower_leg)) +
                  distance(place(Role::right_lower_leg), place(Role::right_foot)));
    if (!(leg_ > 1e-9) || !std::isfinite(leg_)) return false;
    if (!(glm::length(along) > 1e-3 * leg_) || !std::isfinite(glm::length(along))) return false;
    constexpr double kUpright = 0.82, kAhead = 0.94;  // 35 and 20 degrees
    const glm::dvec3 up = snapped(glm::normalize(along), kUpright);
    const glm::dvec3 left = across - up * glm::dot(up, across);
    if (!(glm::length(left) > 1e-3 * leg_) || !std::isfinite(glm::length(left))) return false;
    const glm::dvec3 x = snapped(glm::normalize(left), kAhead);
    axes_ = glm::normalize(glm::quat_cast(glm::dmat3(x, up, glm::cross(x, up))));
    ground_ = hips - up * glm::dot(hips - feet, up);
    return true;
}

}  // namespace bendy
