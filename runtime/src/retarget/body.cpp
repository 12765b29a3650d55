#include "body.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace bendy {
namespace {

constexpr Role kNeeded[] = {Role::hips,      Role::left_upper_leg,  Role::left_lower_leg,
                            Role::left_foot, Role::right_upper_leg, Role::right_lower_leg,
                            Role::right_foot};

constexpr std::array kLegs{Role::left_hind_leg, Role::right_hind_leg, Role::left_front_leg, Role::right_front_leg};
constexpr std::size_t kFewest = 3;                // joints of a leg
constexpr double kUpright = 0.82, kAhead = 0.94;  // 35 and 20 degrees
constexpr auto kLimbRoles =
    static_cast<std::size_t>(Role::right_hand) - static_cast<std::size_t>(Role::left_upper_leg) + 1;

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

std::span<const Role> leg_roles_of(BodyKind kind) {
    return std::span(kLegs).first(kind == BodyKind::human ? 0 : kind == BodyKind::two_legs ? 2 : 4);
}

/// Legs of an animal as chains, and what is known of it before they are divided.
struct LegChains {
    std::vector<std::vector<std::uint32_t>> legs;
    glm::dvec3 up{0.0}, ahead{0.0};  ///< unit
    double ground = std::numeric_limits<double>::infinity();
};

/// Finds where a leg begins and where its foot is.
Limb divide_leg(const Body& body, const LegChains& standing, std::size_t leg) {
    Limb limb;
    limb.joints = standing.legs[leg];
    // A shoulder blade runs forward and the upper arm back, a pelvis back and the thigh forward.
    constexpr double kSlanted = 0.3;  // of the bone's length
    const glm::dvec3 first = body.place(limb.joints[1]) - body.place(limb.joints[0]);
    const double ahead = glm::dot(first, standing.ahead) * (leg < 2 ? -1.0 : 1.0);
    if (limb.joints.size() > kFewest && ahead > kSlanted * glm::length(first)) {
        limb.girdle = {limb.joints.front()};
        limb.joints.erase(limb.joints.begin());
    }
    constexpr double kLow = 0.25;  // of the height of hip or shoulder
    const auto height = [&](std::uint32_t joint) { return glm::dot(standing.up, body.place(joint)) - standing.ground; };
    while (limb.foot + 1 < limb.joints.size() && !(height(limb.foot_joint()) < kLow * height(limb.upper())))
        ++limb.foot;
    return limb;
}

}  // namespace

Body::Body(const Model& model, std::span<const JointTransform> locals, const StandingPoseRecord* standing_pose)
    : model_(model), by_role_(static_cast<std::size_t>(Role::spine_chain), kNone), has_role_(model.joints().size()) {
    for (const JointRole& role : model.roles()) {
        has_role_[role.joint] = true;
        if (role.role < by_role_.size()) by_role_[role.role] = role.joint;
    }
    const auto has_legs = [&](Role left, Role right) { return !chain(left).empty() || !chain(right).empty(); };
    const auto limbs = std::span(by_role_).subspan(static_cast<std::size_t>(Role::left_upper_leg), kLimbRoles);
    const bool has_limb = std::any_of(limbs.begin(), limbs.end(), [](std::uint32_t joint) { return joint != kNone; });
    if (!has_limb && has_legs(Role::left_front_leg, Role::right_front_leg)) kind_ = BodyKind::four_legs;
    if (!has_limb && kind_ == BodyKind::human && has_legs(Role::left_hind_leg, Role::right_hind_leg))
        kind_ = BodyKind::two_legs;
    const auto joints = model.joints();
    rest_.reserve(joints.size());
    turns_.reserve(joints.size());
    if (standing_pose != nullptr) standing_pose_ = *standing_pose;
    for (std::uint32_t number = 0; number < joints.size(); ++number) {  // parents come first
        const Joint& joint = joints[number];
        const glm::dmat4 local = to_matrix(locals[number], joint.shear);
        rest_.push_back(joint.parent == kNone ? local : rest_[joint.parent] * local);
        turns_.push_back(space(joint.parent) * glm::normalize(glm::dquat(locals[number].rotation)));
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
    const std::span<const Role> needed(kNeeded);
    for (const Role role : kind_ == BodyKind::human ? needed : needed.first(1)) {
        if (joint(role) == kNone) missing.push_back(role);
    }
    if (kind_ == BodyKind::human && top() == joint(Role::hips)) missing.push_back(Role::head);
    for (const Role role : leg_roles_of(kind_)) {
        if (chain(role).size() < kFewest) missing.push_back(role);
    }
    return missing;
}

std::uint32_t Body::top() const {
    const std::vector<std::uint32_t> column =
        joints({Role::head, Role::neck, Role::upper_chest, Role::chest, Role::spine, Role::hips});
    return column.empty() ? kNone : column.front();
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

void Body::find_limbs() {
    if (kind_ == BodyKind::human) {
        limbs_.resize(4);
        limbs_[0].joints = joints({Role::left_upper_leg, Role::left_lower_leg, Role::left_foot, Role::left_toes});
        limbs_[1].joints = joints({Role::right_upper_leg, Role::right_lower_leg, Role::right_foot, Role::right_toes});
        const auto arm = [&](std::initializer_list<Role> roles) {
            std::vector<std::uint32_t> found;
            for (const Role role : roles) {
                if (joint(role) == kNone) break;
                found.push_back(joint(role));
            }
            return found;
        };
        limbs_[2].joints = arm({Role::left_upper_arm, Role::left_lower_arm, Role::left_hand});
        limbs_[3].joints = arm({Role::right_upper_arm, Role::right_lower_arm, Role::right_hand});
        limbs_[2].is_leg = limbs_[3].is_leg = false;
        return;
    }
    LegChains standing;
    glm::dvec3 up(0.0), left(0.0);
    for (const Role role : leg_roles_of(kind_)) {
        const std::vector<std::uint32_t>& leg = standing.legs.emplace_back(chain(role));
        up += place(leg.front()) - place(leg.back());
        const double side = standing.legs.size() % 2 == 1 ? 1.0 : -1.0;
        for (const std::uint32_t joint : leg) left += side / static_cast<double>(leg.size()) * place(joint);
    }
    standing.up = snapped(glm::normalize(up), kUpright);
    standing.ahead = glm::normalize(glm::cross(left, standing.up));
    for (const auto& leg : standing.legs) {
        for (const std::uint32_t joint : leg)
            standing.ground = std::min(standing.ground, glm::dot(standing.up, place(joint)));
    }
    for (std::size_t leg = 0; leg < standing.legs.size(); ++leg) limbs_.push_back(divide_leg(*this, standing, leg));
}

/// The standing pose says which way is up, and where the ground of the motions is. Where the body is beside that, it
/// does not say: motions are about the origin.
void Body::stand_on(const std::array<float, 4>& axes, double ground, const glm::dvec3& feet) {
    axes_ = glm::normalize(glm::dquat(axes[3], axes[0], axes[1], axes[2]));
    double lowest = std::numeric_limits<double>::infinity();
    for (std::uint32_t joint = 0; joint < has_role_.size(); ++joint) {
        if (has_role_[joint]) lowest = std::min(lowest, glm::dot(up(), place(joint)));
    }
    ground_ = up() * (ground + glm::dot(up(), feet) - lowest);
}

bool Body::measure() {
    find_limbs();
    const glm::dvec3 hips = 0.5 * (place(limbs_[0].upper()) + place(limbs_[1].upper()));
    const glm::dvec3 feet = 0.5 * (place(limbs_[0].foot_joint()) + place(limbs_[1].foot_joint()));
    glm::dvec3 across(0.0), tops(0.0), bottoms(0.0);
    for (std::size_t left = 0; left < limbs_.size(); left += 2) {
        if (limbs_[left].joints.empty() || limbs_[left + 1].joints.empty()) continue;
        across = across + place(limbs_[left].upper()) - place(limbs_[left + 1].upper());
    }
    for (const Limb& limb : limbs_) {
        if (kind_ == BodyKind::human) break;
        tops += place(limb.upper()) / static_cast<double>(limbs_.size());
        bottoms += place(limb.foot_joint()) / static_cast<double>(limbs_.size());
    }
    const glm::dvec3 along = kind_ == BodyKind::human ? place(top()) - feet : tops - bottoms;
    leg_ = 0.0;
    for (std::size_t leg = 0; leg < 2; ++leg) {
        const Limb& limb = limbs_[leg];
        for (std::size_t k = 0; k < limb.foot; ++k) leg_ += distance(place(limb.joints[k]), place(limb.joints[k + 1]));
    }
    leg_ *= 0.5;
    if (!(leg_ > 1e-9) || !std::isfinite(leg_)) return false;
    if (!(glm::length(along) > 1e-3 * leg_) || !std::isfinite(glm::length(along))) return false;
    const glm::dvec3 up = snapped(glm::normalize(along), kUpright);
    const glm::dvec3 left = across - up * glm::dot(up, across);
    if (!(glm::length(left) > 1e-3 * leg_) || !std::isfinite(glm::length(left))) return false;
    if (standing_pose_) {
        stand_on(standing_pose_->axes, standing_pose_->ground, feet);
        return true;
    }
    const glm::dvec3 x = snapped(glm::normalize(left), kAhead);
    axes_ = glm::normalize(glm::quat_cast(glm::dmat3(x, up, glm::cross(x, up))));
    ground_ = hips - up * glm::dot(hips - feet, up);
    return true;
}

}  // namespace bendy
