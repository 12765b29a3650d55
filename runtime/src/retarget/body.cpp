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

constexpr std::array kLegs{Role::left_hind_leg, Role::right_hind_leg, Role::left_front_leg, Role::right_front_leg};
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

constexpr double kLeastWay = 1e-3;                                        // of the body's size
constexpr glm::dvec3 kModelUp{0.0, 1.0, 0.0}, kModelLeft{1.0, 0.0, 0.0};  // where a body does not say

glm::dvec3 unit_or(const glm::dvec3& v, double least, const glm::dvec3& otherwise) {
    return glm::length(v) > least ? glm::normalize(v) : otherwise;
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
    constexpr double kSlanted = 0.3;    // of the bone's length
    constexpr std::size_t kFewest = 3;  // joints of a leg
    if (limb.joints.size() < kFewest) return limb;
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
    if (kind_ != BodyKind::human) return find_animal_limbs();
    const auto limb = [&](bool is_leg, std::initializer_list<Role> roles) {
        Limb& found = limbs_.emplace_back();
        found.is_leg = is_leg;
        for (const Role role : roles) {
            if (joint(role) == kNone) break;
            found.joints.push_back(joint(role));
        }
    };
    limb(true, {Role::left_upper_leg, Role::left_lower_leg, Role::left_foot, Role::left_toes});
    limb(true, {Role::right_upper_leg, Role::right_lower_leg, Role::right_foot, Role::right_toes});
    limb(false, {Role::left_upper_arm, Role::left_lower_arm, Role::left_hand});
    limb(false, {Role::right_upper_arm, Role::right_lower_arm, Role::right_hand});
}

void Body::find_animal_limbs() {
    LegChains standing;
    glm::dvec3 up(0.0), left(0.0);
    const auto middle = [&](const std::vector<std::uint32_t>& leg) {
        glm::dvec3 sum(0.0);
        for (const std::uint32_t joint : leg) sum += 1.0 / static_cast<double>(leg.size()) * place(joint);
        return sum;
    };
    for (const Role role : leg_roles_of(kind_)) {
        const std::vector<std::uint32_t>& leg = standing.legs.emplace_back(chain(role));
        if (!leg.empty()) up += place(leg.front()) - place(leg.back());
    }
    for (std::size_t leg = 0; leg < standing.legs.size(); leg += 2) {
        if (!standing.legs[leg].empty() && !standing.legs[leg + 1].empty())
            left += middle(standing.legs[leg]) - middle(standing.legs[leg + 1]);
    }
    standing.up = snapped(unit_or(up, 0.0, kModelUp), kUpright);
    standing.ahead = unit_or(glm::cross(unit_or(left, 0.0, kModelLeft), standing.up), 0.0, glm::dvec3(0.0));
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
    raised_ = ground - lowest;
    ground_ = up() * (raised_ + glm::dot(up(), feet));
}

/// Returns the joint of the hips, or else the lowest of the trunk, or any that has a role.
std::uint32_t Body::base() const {
    for (const Role role : {Role::hips, Role::spine, Role::chest, Role::upper_chest, Role::neck, Role::head}) {
        if (joint(role) != kNone) return joint(role);
    }
    return model_.roles().front().joint;
}

/// Returns the middle between the feet, or between where the legs end; the hips if there are no legs.
glm::dvec3 Body::find_feet() const {
    glm::dvec3 feet(0.0);
    double count = 0.0;
    for (const Limb& leg : std::span(limbs_).first(2)) {
        if (leg.joints.empty()) continue;
        feet += place(leg.end());
        count += 1.0;
    }
    return count > 0.0 ? 1.0 / count * feet : hips_;
}

/// Returns the mean length of the bones of a limb and its counterpart on the other side, as far as they have them.
double Body::length_of(std::size_t first_limb, std::size_t bones) const {
    double sum = 0.0, count = 0.0;
    for (std::size_t k = first_limb; k < std::min(first_limb + 2, limbs_.size()); ++k) {
        const Limb& limb = limbs_[k];
        const std::size_t last = std::min(bones, limb.foot);
        if (limb.joints.size() <= last) continue;
        for (std::size_t bone = 0; bone < last; ++bone)
            sum += distance(place(limb.joints[bone]), place(limb.joints[bone + 1]));
        count += 1.0;
    }
    return count > 0.0 ? sum / count : 0.0;
}

glm::dvec3 Body::find_up(const glm::dvec3& feet) const {
    glm::dvec3 up(0.0);
    if (kind_ == BodyKind::human) {
        if (top() != kNone) up = place(top()) - feet;
    } else {
        for (const Limb& limb : limbs_) {
            if (limb.joints.empty()) continue;
            up += (place(limb.upper()) - place(limb.end())) / static_cast<double>(limbs_.size());
        }
    }
    return snapped(unit_or(up, least_way(), kModelUp), kUpright);
}

glm::dvec3 Body::find_left(const glm::dvec3& up) const {
    glm::dvec3 across(0.0);
    for (std::size_t left = 0; left < limbs_.size(); left += 2) {
        if (limbs_[left].joints.empty() || limbs_[left + 1].joints.empty()) continue;
        across = across + place(limbs_[left].upper()) - place(limbs_[left + 1].upper());
    }
    const auto level = [&](const glm::dvec3& way) { return way - up * glm::dot(up, way); };
    const glm::dvec3 of_model = unit_or(level(kModelLeft), kLeastWay, glm::dvec3(0.0, 0.0, 1.0));
    return unit_or(level(across), least_way(), of_model);
}

/// Returns the length below which a difference of places says nothing, metres.
double Body::least_way() const {
    return kLeastWay * *std::max_element(lengths_.begin(), lengths_.end());
}

bool Body::stands_anyhow() const {
    const auto evidence =
        standing_pose_ ? static_cast<StandingEvidence>(standing_pose_->evidence) : StandingEvidence::told;
    return evidence == StandingEvidence::clip || evidence == StandingEvidence::assumed;
}

bool Body::measure() {
    find_limbs();
    hips_ = place(base());
    if (has_hip_joints()) hips_ = 0.5 * (place(limbs_[0].upper()) + place(limbs_[1].upper()));
    const glm::dvec3 feet = find_feet();
    constexpr std::size_t kUpperBone = 1, kWhole = std::numeric_limits<std::size_t>::max();
    lengths_ = {length_of(0, kWhole), length_of(0, kUpperBone),
                top() == kNone ? 0.0 : distance(place(base()), place(top())), length_of(2, kWhole)};
    for (const double length : lengths_) {
        if (!std::isfinite(length)) return false;
    }
    const glm::dvec3 up = find_up(feet);
    const glm::dvec3 left = find_left(up);
    if (!std::isfinite(glm::dot(up, left) + glm::dot(hips_, feet))) return false;
    if (standing_pose_) {
        stand_on(standing_pose_->axes, standing_pose_->ground, feet);
        return true;
    }
    const glm::dvec3 x = snapped(left, kAhead);
    axes_ = glm::normalize(glm::quat_cast(glm::dmat3(x, up, glm::cross(x, up))));
    ground_ = hips_ - up * glm::dot(hips_ - feet, up);
    return true;
}

}  // namespace bendy
