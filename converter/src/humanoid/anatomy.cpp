#include "anatomy.h"

#include <bendy/format/trig.h>

#include <glm/geometric.hpp>

#include <algorithm>

namespace bendy::converter {
namespace {

constexpr double kStrange = 10.0;  // degrees outside: this is no human's joint, or it has another rest pose

// From the AAOS tables as Norkin & White, Measurement of Joint Motion, appendix A, give them, if nothing else is said.
//   shoulder: flexion 180, extension 60, abduction 180, rotation 70 inward, 90 outward; adduction 50 (AMA Guides).
//   About
//     the T-pose Y is the arm's way back: 135 forward; 90, so that the ellipse leaves the hanging arm its extension.
//   clavicle: elevation 45, depression 10, forward 20, back 25, rotation 50 back (Levangie & Norkin, Joint Structure)
//   elbow 0 to 150; forearm 80 either way, given to the wrist as most rigs turn it there
//   wrist: flexion 80, extension 70, to the thumb 20, to the little finger 30
//   hip: flexion 120, extension 30, abduction 45, adduction 30, rotation 45 either way
//   knee 0 to 135; bent, the shin turns 30 either way (Levangie & Norkin)
//   elbow and knee sideways 10: play of the rig, no human's
//   ankle: up 20, down 50, inversion 35, eversion 15; foot outward 10, inward 20 (Magee, Orthopedic Physical
//   Assessment) toes: up 80, down 30 (Merck Manual) neck and head together: forward, back and sideways 45, rotation 60
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

Ranges reflected(const Ranges& left) {
    return {reflected(left.x), left.y, reflected(left.z)};
}

Range divided(const Range& range, double by) {
    return {range.low / by, range.high / by};
}

Ranges divided(const Ranges& ranges, std::size_t by) {
    const auto n = static_cast<double>(by);
    return {divided(ranges.x, n), divided(ranges.y, n), divided(ranges.z, n)};
}

/// The rotation by the shortest way, as axis times angle in degrees.
glm::dvec3 swing_between(glm::dvec3 from, glm::dvec3 to) {
    const glm::dvec3 axis = glm::cross(from, to);
    const double sine = glm::length(axis);
    if (sine < 1e-9) return glm::dvec3(0.0);
    return axis * (trig::atan2(sine, glm::dot(from, to)) / trig::kDegree / sine);
}

class Anatomist {
public:
    Anatomist(const Scene& scene, const RestFrames& rest, const NamedHumanoid& found, const Stance& stance)
        : scene_(scene), rest_(rest), found_(found), bones_(found.bones), stance_(stance) {}

    std::vector<JointAnatomy> find() {
        find_trunk();
        find_limbs(false);
        find_limbs(true);
        return std::move(joints_);
    }

private:
    [[nodiscard]] static HumanBone of_side(HumanBone left, bool right) { return right ? mirrored(left) : left; }
    [[nodiscard]] static Ranges of_side(const Ranges& left, bool right) { return right ? reflected(left) : left; }
    [[nodiscard]] static Ranges bend_of_side(const Ranges& left, bool right) {
        return right ? Ranges{reflected(left.x), reflected(left.y), left.z} : left;
    }

    void find_limbs(bool right) {
        const auto joint = [&](HumanBone left) { return bones_[of_side(left, right)]; };
        const std::uint32_t shoulder = joint(HumanBone::left_shoulder);
        const std::uint32_t upper_arm = joint(HumanBone::left_upper_arm);
        const std::uint32_t lower_arm = joint(HumanBone::left_lower_arm);
        const std::uint32_t hand = joint(HumanBone::left_hand);
        const std::uint32_t upper_leg = joint(HumanBone::left_upper_leg);
        const std::uint32_t lower_leg = joint(HumanBone::left_lower_leg);
        const std::uint32_t foot = joint(HumanBone::left_foot);
        const std::uint32_t toes = joint(HumanBone::left_toes);
        const glm::dvec3 outward = right ? -stance_.left : stance_.left;
        is_right_ = right;

        add_swing(shoulder, HumanJoint::collarbone, along(shoulder, upper_arm), stance_.forward,
                  of_side(kShoulder, right));
        add_swing(upper_arm, HumanJoint::shoulder, along(upper_arm, lower_arm), stance_.forward,
                  of_side(kUpperArm, right), outward);
        add_bend(upper_arm, lower_arm, HumanJoint::elbow,
                 end_of(found_, rest_, right ? Limb::right_arm : Limb::left_arm), stance_.forward,
                 bend_of_side(kForearm, right));
        if (!found_.has_split_hands) {
            const auto to_thumb = along(hand, joint(HumanBone::left_thumb));
            add_swing(hand, HumanJoint::wrist, along(lower_arm, hand), to_thumb ? *to_thumb : stance_.forward,
                      of_side(kHand, right));
        }
        add_swing(upper_leg, HumanJoint::hip, along(upper_leg, lower_leg), stance_.forward, of_side(kUpperLeg, right),
                  -stance_.up);
        add_bend(upper_leg, lower_leg, HumanJoint::knee,
                 end_of(found_, rest_, right ? Limb::right_leg : Limb::left_leg), -stance_.forward,
                 bend_of_side(kShin, right));
        const auto to_toes = along(foot, toes);
        add_swing(foot, HumanJoint::ankle, to_toes ? *to_toes : stance_.forward, stance_.up, of_side(kFoot, right));
        add(toes, HumanJoint::toes,
            glm::dmat3(stance_.forward, glm::cross(stance_.left, stance_.forward), stance_.left),
            bend_of_side(kToes, right), {});
    }

    void find_trunk() {
        is_right_ = false;
        const std::uint32_t spine = bones_[HumanBone::spine];
        const std::uint32_t neck = bones_[HumanBone::neck];
        const std::uint32_t head = bones_[HumanBone::head];
        if (head == kNone) return;
        const std::uint32_t first_of_neck = neck != kNone ? neck : head;
        if (spine != kNone) {
            std::vector<std::uint32_t> path = path_of(scene_, spine, first_of_neck);
            if (!path.empty()) path.pop_back();
            add_column(path, first_of_neck, HumanJoint::spine, divided(kSpine, path.size()));
        }
        const std::vector<std::uint32_t> path = path_of(scene_, first_of_neck, head);
        add_column(path, kNone, HumanJoint::neck, divided(kNeck, path.size()));
    }

    /// Joints above one another; `next` follows the last one.
    void add_column(const std::vector<std::uint32_t>& joints, std::uint32_t next, HumanJoint part,
                    const Ranges& ranges) {
        for (std::size_t i = 0; i < joints.size(); ++i) {
            const auto direction = along(joints[i], i + 1 < joints.size() ? joints[i + 1] : next);
            add_swing(joints[i], part, direction ? *direction : stance_.up, stance_.forward, ranges);
            if (joints.size() > 1 && !joints_.empty() && joints_.back().joint == joints[i])
                joints_.back().number = static_cast<std::uint8_t>(std::min<std::size_t>(i + 1, 255));
        }
    }

    [[nodiscard]] std::optional<glm::dvec3> along(std::uint32_t from, std::uint32_t to) const {
        return from == kNone || to == kNone ? std::nullopt : rest_.direction(from, to);
    }

    /// Swing and twist with X along the bone and Z as near `z` as may be. Where a `neutral` direction is given the
    /// ranges are about the bone pointing there.
    void add_swing(std::uint32_t joint, HumanJoint part, std::optional<glm::dvec3> x, glm::dvec3 z,
                   const Ranges& ranges, std::optional<glm::dvec3> neutral = std::nullopt) {
        if (joint == kNone || !x) return;
        const std::optional<glm::dvec3> across = unit_across(z, *x);
        if (!across) return;
        const glm::dmat3 axes(*x, glm::cross(*across, *x), *across);
        const glm::dvec3 swing = neutral ? swing_between(*neutral, *x) : glm::dvec3(0.0);
        add(joint, part, axes, ranges, {0.0, glm::dot(swing, axes[1]), glm::dot(swing, axes[2])});
    }

    /// The bend between two bones of a limb. At rest it is bent by some angle already.
    void add_bend(std::uint32_t upper, std::uint32_t lower, HumanJoint part, std::optional<glm::dvec3> end,
                  glm::dvec3 towards, const Ranges& ranges) {
        if (lower == kNone || !end) return;
        const auto first = along(upper, lower);
        const auto second = unit(*end - rest_.position(lower));
        if (!first || !second) return;
        const auto side = unit_across(towards, *first);
        if (!side) return;
        glm::dvec3 axis = glm::cross(*first, *side);
        const glm::dvec3 bend = swing_between(*first, *second);
        const double angle = glm::length(bend);
        // A limb that is clearly bent shows its axis. One that is bent elsewhere, or by that much to the wrong side, is
        // no human's.
        const bool is_elsewhere = angle > kStrange && glm::dot(bend / angle, axis) < 0.5;
        if (angle > kStrange && !is_elsewhere) axis = bend / angle;
        const auto z = unit_across(axis, *second);
        if (!z) return;
        const glm::dmat3 axes(*second, glm::cross(*z, *second), *z);
        add(lower, part, axes, ranges, glm::transpose(axes) * bend);
        if (!joints_.empty() && joints_.back().joint == lower && is_elsewhere) joints_.back().is_strange = true;
    }

    void add(std::uint32_t joint, HumanJoint part, const glm::dmat3& axes, const Ranges& ranges,
             const glm::dvec3& rest) {
        if (joint == kNone || !rest_.turning_axes(joint)) return;
        const bool is_strange =
            outside(ranges.z, rest.z) > kStrange || (!bends(part) && outside(ranges.y, rest.y) > kStrange);
        joints_.push_back({joint, part, is_right_, 0, axes, ranges, rest, is_strange});
    }

    const Scene& scene_;
    const RestFrames& rest_;
    const NamedHumanoid& found_;
    const Humanoid& bones_;
    const Stance& stance_;
    bool is_right_ = false;
    std::vector<JointAnatomy> joints_;
};

}  // namespace

std::vector<JointAnatomy> find_anatomy(const Scene& scene, const RestFrames& rest, const NamedHumanoid& found,
                                       const Stance& stance) {
    return Anatomist(scene, rest, found, stance).find();
}

Ranges ranges_from_rest(const Ranges& human, const glm::dvec3& rest) {
    const auto moved = [](const Range& range, double zero) {
        return Range{std::min(range.low - zero, 0.0), std::max(range.high - zero, 0.0)};
    };
    return {moved(human.x, rest.x), moved(human.y, rest.y), moved(human.z, rest.z)};
}

double outside(const Range& range, double rest) {
    return std::max({range.low - rest, rest - range.high, 0.0});
}

}  // namespace bendy::converter
