#include "same_rig.h"

#include "model/standing_rotations.h"

#include <bendy/runtime/binding.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace bendy {
namespace {

constexpr float kSame = 1e-3f;    // of a bone's length, and of a scale
constexpr double kTurned = 1e-3;  // radians

bool are_near(const glm::vec3& a, const glm::vec3& b) {
    return glm::length(a - b) <= kSame * std::max(glm::length(a), glm::length(b)) + 1e-6f;
}

/// Returns by joint whether it has a role, or one of its descendants does.
std::vector<bool> list_body(const Model& model) {
    std::vector<bool> is_body(model.joints().size());
    for (const JointRole& role : model.roles()) is_body[role.joint] = true;
    for (std::size_t joint = is_body.size(); joint-- > 0;) {  // parents come first
        const std::uint32_t parent = model.parents()[joint];
        if (is_body[joint] && parent != kNone) is_body[parent] = true;
    }
    return is_body;
}

bool are_turned(const glm::quat& a, const glm::quat& b) {
    const glm::dquat by = glm::conjugate(glm::dquat(a)) * glm::dquat(b);
    return 2.0 * glm::length(glm::dvec3(by.x, by.y, by.z)) > kTurned;
}

std::uint32_t hips_of(const Model& model) {
    const auto hips = std::find_if(model.roles().begin(), model.roles().end(), [](const JointRole& role) {
        return role.role == static_cast<std::uint16_t>(Role::hips);
    });
    return hips == model.roles().end() ? kNone : hips->joint;
}

}  // namespace

std::vector<JointTransform> standing_locals(const Model& model) {
    std::vector<JointTransform> locals;
    locals.reserve(model.joints().size());
    for (const Joint& joint : model.joints()) locals.push_back(joint.rest);
    for (const StandingJoint& standing : standing_rotations(model)) locals[standing.joint].rotation = standing.rotation;
    return locals;
}

std::vector<JointTransform> locals_of_same_rig(const Model& source, const Model& target) {
    const std::uint32_t hips = hips_of(source);
    if (hips == kNone || source.roles().size() != target.roles().size()) return {};
    const Binding names(source, target);
    const std::vector<bool> is_body = list_body(source);
    std::vector<JointTransform> locals = standing_locals(source);
    const std::vector<JointTransform> others = standing_locals(target);
    bool is_above_hips = true, rests_otherwise = false;
    for (std::uint32_t joint = 0; joint < is_body.size(); ++joint) {
        if (!is_body[joint]) continue;
        const std::uint32_t other = names.joints()[joint];
        if (other == kNone) return {};
        const std::uint32_t parent = source.parents()[joint];
        const std::uint32_t other_parent = target.parents()[other];
        if ((parent == kNone) != (other_parent == kNone)) return {};
        if (parent != kNone && names.joints()[parent] != other_parent) return {};
        const Joint& from = source.joints()[joint];
        const Joint& to = target.joints()[other];
        if (!are_near(from.rest.scale, to.rest.scale) || from.shear != to.shear) return {};
        is_above_hips = is_above_hips && joint != hips;
        if (is_above_hips && !(from.rest.rotation == to.rest.rotation)) return {};
        if (joint != hips && !are_near(from.rest.translation, to.rest.translation)) return {};
        rests_otherwise = rests_otherwise || are_turned(locals[joint].rotation, others[other].rotation);
        locals[joint] = others[other];
    }
    if (!rests_otherwise) return {};
    const bool have_same_roles =
        std::equal(source.roles().begin(), source.roles().end(), target.roles().begin(),
                   [&](const JointRole& a, const JointRole& b) {
                       return names.joints()[a.joint] == b.joint && a.role == b.role && a.place == b.place;
                   });
    return have_same_roles ? locals : std::vector<JointTransform>();
}

}  // namespace bendy
