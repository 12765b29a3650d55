#include "anatomy.h"

#include <bendy/format/trig.h>

#include <glm/geometric.hpp>

#include <algorithm>

namespace bendy::converter {
namespace {

constexpr double kStrange = 10.0;  // degrees outside: not a human's joint, or in another rest pose

// Unless noted otherwise, from the AAOS tables as given by Norkin & White, Measurement of Joint Motion, appendix A.
//   shoulder: flexion 180, extension 60, abduction 180, rotation 70 inward, 90 outward; adduction 50 (AMA Guides).
//     About the T-pose's Y, the arm goes 135 forward and 90 back, so that the ellipse leaves a hanging arm its
//     extension.
//   clavicle: elevation 45, depression 10, forward 20, back 25, rotation 50 back (Levangie & Norkin, Joint Structure)
//   elbow 0 to 150; forearm 80 either way, assigned to the wrist, where most rigs turn it
//   wrist: flexion 80, extension 70, to the thumb 20, to the little finger 30
//   hip: flexion 120, extension 30, abduction 45, adduction 30, rotation 45 either way
//   knee 0 to 135; bent, the shin turns 30 either way (Levangie & Norkin)
//   elbow and knee sideways 10: tolerance for rigs; humans have none
//   ankle: up 20, down 50, inversion 35, eversion 15; foot outward 10, inward 20 (Magee, Orthopedic Physical
//   Assessment)
//   toes: up 80, down 30 (Merck Manual)
//   neck and head together: forward, back and sideways 45, rotation 60
//   spine, all joints together: forward 80, back 25, sideways 35, rotation 45
constexpr Ranges kShoulder{{-50, 10}, {-20, 25}, {-10, 45}};  // Z forward: + raises
constexpr Ranges kUpperArm{{-90, 70}, {-135, 90}, {-140, 90}};
constexpr Range kElbow{0, 150};
constexpr Ranges kForearm{{-80, 80}, {-10, 10}, kElbow};  // Z the hinge
constexpr Ranges kHand{{-80, 80}, {-20, 30}, {-80, 70}};  // Z to the thumb: + extends
constexpr Ranges kUpperLeg{{-45, 45}, {-120, 30}, {-30, 45}};
constexpr Range kKnee{0, 135};
constexpr Ranges kShin{{-30, 30}, {-10, 10}, kKnee};      // Z the hinge
constexpr Ranges kFoot{{-35, 15}, {-20, 50}, {-20, 10}};  // Z up: + outward
constexpr Ranges kToes{{-10, 10}, {-10, 10}, {-80, 30}};  // Z to the left: + down
constexpr Ranges kNeck{{-60, 60}, {-45, 45}, {-45, 45}};  // Y to the right: - bends forward
constexpr Ranges kSpine{{-45, 45}, {-80, 25}, {-35, 35}};

Range reflected(const Range& range) {
    return {-range.high, -range.low};
}

Range divided(const Range& range, double by) {
    return {range.low / by, range.high / by};
}

/// The widest range that clips may justify: larger angles are taken for mistakes in the clip.
Ranges widened(const Ranges& ranges) {
    constexpr double kMore = 30.0;  // degrees
    const auto wider = [](const Range& range) { return Range{range.low - kMore, range.high + kMore}; };
    return {wider(ranges.x), wider(ranges.y), wider(ranges.z)};
}

/// The shortest rotation between two directions, as axis times angle in degrees.
glm::dvec3 swing_between(glm::dvec3 from, glm::dvec3 to) {
    const glm::dvec3 axis = glm::cross(from, to);
    const double sine = glm::length(axis);
    if (sine < 1e-9) return glm::dvec3(0.0);
    return axis * (trig::atan2(sine, glm::dot(from, to)) / trig::kDegree / sine);
}

class HumanAnatomy {
public:
    HumanAnatomy(const Scene& scene, const RestFrames& rest, const NamedHumanoid& found, const Stance& stance)
        : scene_(scene), rest_(rest), found_(found), bones_(found.bones), stance_(stance), joints_(rest, stance) {}

    std::vector<JointAnatomy> find() {
        find_trunk();
        find_limbs(false);
        find_limbs(true);
        return joints_.take();
    }

private:
    void find_limbs(bool right) {
        const auto joint = [&](HumanBone left) { return bones_[right ? mirrored(left) : left]; };
        const auto along = [&](std::uint32_t from, std::uint32_t to) { return joints_.along(from, to); };
        const std::uint32_t shoulder = joint(HumanBone::left_shoulder);
        const std::uint32_t upper_arm = joint(HumanBone::left_upper_arm);
        const std::uint32_t lower_arm = joint(HumanBone::left_lower_arm);
        const std::uint32_t hand = joint(HumanBone::left_hand);
        const std::uint32_t upper_leg = joint(HumanBone::left_upper_leg);
        const std::uint32_t lower_leg = joint(HumanBone::left_lower_leg);
        const std::uint32_t foot = joint(HumanBone::left_foot);
        const std::uint32_t toes = joint(HumanBone::left_toes);
        const glm::dvec3 outward = right ? -stance_.left : stance_.left;
        joints_.set_side(right);

        joints_.add_swing(shoulder, BodyJoint::collarbone, along(shoulder, upper_arm), stance_.forward, kShoulder);
        joints_.add_swing(upper_arm, BodyJoint::shoulder, along(upper_arm, lower_arm), stance_.forward, kUpperArm,
                          outward);
        joints_.add_bend(upper_arm, lower_arm, BodyJoint::elbow,
                         end_of(found_, rest_, right ? Limb::right_arm : Limb::left_arm), stance_.forward, kForearm);
        if (!found_.has_split_hands) {
            const std::uint32_t first = joint(HumanBone::left_thumb_metacarpal);
            const auto to_thumb = along(hand, first != kNone ? first : joint(HumanBone::left_thumb_proximal));
            joints_.add_swing(hand, BodyJoint::wrist, along(lower_arm, hand), to_thumb ? *to_thumb : stance_.forward,
                              kHand);
        }
        joints_.add_swing(upper_leg, BodyJoint::hip, along(upper_leg, lower_leg), stance_.forward, kUpperLeg,
                          -stance_.up);
        joints_.add_bend(upper_leg, lower_leg, BodyJoint::knee,
                         end_of(found_, rest_, right ? Limb::right_leg : Limb::left_leg), -stance_.forward, kShin);
        const auto to_toes = along(foot, toes);
        joints_.add_swing(foot, BodyJoint::ankle, to_toes ? *to_toes : stance_.forward, stance_.up, kFoot);
        joints_.add_toes(toes, kToes);
    }

    void find_trunk() {
        const std::uint32_t spine = bones_[HumanBone::spine];
        const std::uint32_t neck = bones_[HumanBone::neck];
        const std::uint32_t head = bones_[HumanBone::head];
        if (head == kNone) return;
        const std::uint32_t first_of_neck = neck != kNone ? neck : head;
        if (spine != kNone) {
            std::vector<std::uint32_t> path = path_of(scene_, spine, first_of_neck);
            if (!path.empty()) path.pop_back();
            joints_.add_column(path, first_of_neck, BodyJoint::spine, kSpine, stance_.up, stance_.forward);
        }
        joints_.add_column(path_of(scene_, first_of_neck, head), kNone, BodyJoint::neck, kNeck, stance_.up,
                           stance_.forward);
    }

    const Scene& scene_;
    const RestFrames& rest_;
    const NamedHumanoid& found_;
    const Humanoid& bones_;
    const Stance& stance_;
    AnatomyBuilder joints_;
};

}  // namespace

std::optional<glm::dvec3> AnatomyBuilder::along(std::uint32_t from, std::uint32_t to) const {
    return from == kNone || to == kNone ? std::nullopt : rest_.direction(from, to);
}

void AnatomyBuilder::add_column(const std::vector<std::uint32_t>& joints, std::uint32_t next, BodyJoint part,
                                const Ranges& together, const glm::dvec3& straight, std::optional<glm::dvec3> z) {
    is_right_ = false;
    const auto count = static_cast<double>(joints.size());
    const Ranges each{divided(together.x, count), divided(together.y, count), divided(together.z, count)};
    for (std::size_t i = 0; i < joints.size(); ++i) {
        const auto direction = along(joints[i], i + 1 < joints.size() ? joints[i + 1] : next);
        const std::size_t added = joints_.size();
        const glm::dvec3 x = direction ? *direction : straight;
        add_swing(joints[i], part, x, z ? *z : glm::cross(x, stance_.left), each, std::nullopt,
                  joints.size() > 1 ? i + 1 : 0);
        if (joints_.size() > added) joints_.back().widest = widened(together);
    }
}

void AnatomyBuilder::add_swing(std::uint32_t joint, BodyJoint part, std::optional<glm::dvec3> x, glm::dvec3 z,
                               const Ranges& typical, std::optional<glm::dvec3> neutral, std::size_t number) {
    if (joint == kNone || !x) return;
    const std::optional<glm::dvec3> across = unit_across(z, *x);
    if (!across) return;
    const glm::dmat3 axes(*x, glm::cross(*across, *x), *across);
    const glm::dvec3 swing = neutral ? swing_between(*neutral, *x) : glm::dvec3(0.0);
    const Ranges ranges = is_right_ ? Ranges{reflected(typical.x), typical.y, reflected(typical.z)} : typical;
    add(joint, part, axes, ranges, {0.0, glm::dot(swing, axes[1]), glm::dot(swing, axes[2])}, number);
}

void AnatomyBuilder::add_bend(std::uint32_t upper, std::uint32_t lower, BodyJoint part, std::optional<glm::dvec3> end,
                              glm::dvec3 towards, const Ranges& typical, std::size_t number) {
    if (lower == kNone || !end) return;
    const auto first = along(upper, lower);
    const auto second = unit(*end - rest_.position(lower));
    if (!first || !second) return;
    const auto side = unit_across(towards, *first);
    if (!side) return;
    glm::dvec3 axis = glm::cross(*first, *side);
    const glm::dvec3 bend = *bend_between(upper, lower, *end);
    const double angle = glm::length(bend);
    // A limb that is clearly bent shows its axis. If it bends about another axis, or that far to the wrong side, it is
    // not this kind of joint.
    const bool is_elsewhere = angle > kStrange && glm::dot(bend / angle, axis) < 0.5;
    if (angle > kStrange && !is_elsewhere) axis = bend / angle;
    const auto z = unit_across(axis, *second);
    if (!z) return;
    const glm::dmat3 axes(*second, glm::cross(*z, *second), *z);
    const std::size_t added = joints_.size();
    add(lower, part, axes, bend_of_side(typical), glm::transpose(axes) * bend, number);
    if (joints_.size() > added && is_elsewhere) joints_.back().is_strange = true;
}

std::optional<glm::dvec3> AnatomyBuilder::bend_between(std::uint32_t upper, std::uint32_t lower,
                                                       const glm::dvec3& end) const {
    const auto first = along(upper, lower);
    const auto second = unit(end - rest_.position(lower));
    return first && second ? std::optional(swing_between(*first, *second)) : std::nullopt;
}

void AnatomyBuilder::add_toes(std::uint32_t joint, const Ranges& typical) {
    if (joint == kNone) return;
    add(joint, BodyJoint::toes, glm::dmat3(stance_.forward, -stance_.up, stance_.left), bend_of_side(typical),
        glm::dvec3(0.0), 0);
}

Ranges AnatomyBuilder::bend_of_side(const Ranges& left) const {
    return is_right_ ? Ranges{reflected(left.x), reflected(left.y), left.z} : left;
}

void AnatomyBuilder::add(std::uint32_t joint, BodyJoint part, const glm::dmat3& axes, const Ranges& typical,
                         const glm::dvec3& rest, std::size_t number) {
    if (!rest_.turning_axes(joint)) return;
    const bool is_strange =
        outside(typical.z, rest.z) > kStrange || (!bends(part) && outside(typical.y, rest.y) > kStrange);
    joints_.push_back({joint, part, is_right_, static_cast<std::uint8_t>(std::min<std::size_t>(number, 255)), axes,
                       typical, widened(typical), rest, is_strange});
}

std::vector<JointAnatomy> find_anatomy(const Scene& scene, const RestFrames& rest, const NamedHumanoid& found,
                                       const Stance& stance) {
    return HumanAnatomy(scene, rest, found, stance).find();
}

Ranges ranges_from_rest(const Ranges& ranges, const glm::dvec3& rest) {
    const auto moved = [](const Range& range, double zero) {
        return Range{std::min(range.low - zero, 0.0), std::max(range.high - zero, 0.0)};
    };
    return {moved(ranges.x, rest.x), moved(ranges.y, rest.y), moved(ranges.z, rest.z)};
}

double outside(const Range& range, double rest) {
    return std::max({range.low - rest, rest - range.high, 0.0});
}

}  // namespace bendy::converter
