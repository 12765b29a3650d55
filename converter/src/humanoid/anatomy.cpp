#include "anatomy.h"

#include <bendy/format/constraint.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

namespace bendy::converter {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kStrange = 10.0;  // degrees outside: this is no human's joint, or it has another rest pose

/// Degrees.
struct Range {
    double low = 0.0;
    double high = 0.0;
};

/// Ranges of a left joint about the axes of its frame: X along the bone, Z as said, Y = Z x X.
struct Ranges {
    Range x, y, z;
};

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
constexpr Range kToes{-80, 30};
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

/// Moves the range's zero to where the rest pose is; false if the rest pose is far outside.
bool move_zero(Range& range, double rest) {
    range = {range.low - rest, range.high - rest};
    if (range.low > kStrange || range.high < -kStrange) return false;
    range.low = std::min(range.low, 0.0);
    range.high = std::max(range.high, 0.0);
    return true;
}

/// The rotation by the shortest way, as axis times angle in degrees.
glm::dvec3 swing_between(glm::dvec3 from, glm::dvec3 to) {
    const glm::dvec3 axis = glm::cross(from, to);
    const double sine = glm::length(axis);
    if (sine < 1e-9) return glm::dvec3(0.0);
    return axis * (std::atan2(sine, glm::dot(from, to)) / kDegree / sine);
}

class Proposer {
public:
    Proposer(const Scene& scene, const RestFrames& rest, const NamedHumanoid& found, const Stance& stance,
             Report& report)
        : scene_(scene), rest_(rest), found_(found), bones_(found.bones), stance_(stance), report_(report) {}

    std::vector<ProposedLimit> propose() {
        propose_trunk();
        propose_limbs(false);
        propose_limbs(true);
        return std::move(limits_);
    }

private:
    [[nodiscard]] static HumanBone of_side(HumanBone left, bool right) { return right ? mirrored(left) : left; }

    void propose_limbs(bool right) {
        const std::uint32_t shoulder = bones_[of_side(HumanBone::left_shoulder, right)];
        const std::uint32_t upper_arm = bones_[of_side(HumanBone::left_upper_arm, right)];
        const std::uint32_t lower_arm = bones_[of_side(HumanBone::left_lower_arm, right)];
        const std::uint32_t hand = bones_[of_side(HumanBone::left_hand, right)];
        const std::uint32_t thumb = bones_[of_side(HumanBone::left_thumb, right)];
        const std::uint32_t upper_leg = bones_[of_side(HumanBone::left_upper_leg, right)];
        const std::uint32_t lower_leg = bones_[of_side(HumanBone::left_lower_leg, right)];
        const std::uint32_t foot = bones_[of_side(HumanBone::left_foot, right)];
        const std::uint32_t toes = bones_[of_side(HumanBone::left_toes, right)];
        const glm::dvec3 outward = right ? -stance_.left : stance_.left;

        propose_swing(shoulder, along(shoulder, upper_arm), stance_.forward, of_side(kShoulder, right));
        propose_swing(upper_arm, along(upper_arm, lower_arm), stance_.forward, of_side(kUpperArm, right), outward);
        propose_bend(upper_arm, lower_arm, end_of(hand, right ? 1 : 0), stance_.forward, kForearm);
        if (!found_.has_split_hands) {
            const auto to_thumb = along(hand, thumb);
            propose_swing(hand, along(lower_arm, hand), to_thumb ? *to_thumb : stance_.forward, of_side(kHand, right));
        }
        propose_swing(upper_leg, along(upper_leg, lower_leg), stance_.forward, of_side(kUpperLeg, right), -stance_.up);
        propose_bend(upper_leg, lower_leg, end_of(foot, right ? 3 : 2), -stance_.forward, kShin);
        const auto to_toes = along(foot, toes);
        propose_swing(foot, to_toes ? *to_toes : stance_.forward, stance_.up, of_side(kFoot, right));
        propose_hinge(toes, stance_.left, kToes);
    }

    void propose_trunk() {
        const std::uint32_t spine = bones_[HumanBone::spine];
        const std::uint32_t neck = bones_[HumanBone::neck];
        const std::uint32_t head = bones_[HumanBone::head];
        if (head == kNone) return;
        const std::uint32_t first_of_neck = neck != kNone ? neck : head;
        if (spine != kNone) {
            std::vector<std::uint32_t> path = path_of(scene_, spine, first_of_neck);
            if (!path.empty()) path.pop_back();
            propose_column(path, first_of_neck, divided(kSpine, path.size()));
        }
        const std::vector<std::uint32_t> path = path_of(scene_, first_of_neck, head);
        propose_column(path, kNone, divided(kNeck, path.size()));
    }

    /// Joints above one another; `next` follows the last one.
    void propose_column(const std::vector<std::uint32_t>& joints, std::uint32_t next, const Ranges& ranges) {
        for (std::size_t i = 0; i < joints.size(); ++i) {
            const auto direction = along(joints[i], i + 1 < joints.size() ? joints[i + 1] : next);
            propose_swing(joints[i], direction ? *direction : stance_.up, stance_.forward, ranges);
        }
    }

    [[nodiscard]] static Ranges of_side(const Ranges& left, bool right) { return right ? reflected(left) : left; }

    [[nodiscard]] std::optional<glm::dvec3> along(std::uint32_t from, std::uint32_t to) const {
        return from == kNone || to == kNone ? std::nullopt : rest_.direction(from, to);
    }

    /// The joint where the limb ends, below it or loose.
    [[nodiscard]] std::uint32_t end_of(std::uint32_t joint, std::size_t limb) const {
        return joint != kNone ? joint : found_.loose_ends[limb];
    }

    /// A swing-twist limit with X along the bone and Z as near `z` as may be. Where a `neutral` direction is given the
    /// ranges are about the bone pointing there, and are moved to the rest pose.
    void propose_swing(std::uint32_t joint, std::optional<glm::dvec3> x, glm::dvec3 z, Ranges ranges,
                       std::optional<glm::dvec3> neutral = std::nullopt) {
        if (joint == kNone || !x) return;
        const std::optional<glm::dvec3> across = unit_across(z, *x);
        if (!across) return;
        const glm::dvec3 y = glm::cross(*across, *x);
        if (neutral) {
            const glm::dvec3 swing = swing_between(*neutral, *x);
            if (!move_zero(ranges.y, glm::dot(swing, y)) || !move_zero(ranges.z, glm::dot(swing, *across)))
                return warn_of_strange_rest(joint);
        }
        add(joint, LimitModel::swing_twist_ellipse, glm::dmat3(*x, y, *across), ranges);
    }

    /// The hinge between two bones of a limb. At rest it is bent by some angle already: the range's zero moves there.
    void propose_bend(std::uint32_t upper, std::uint32_t lower, std::uint32_t end, glm::dvec3 towards, Ranges ranges) {
        const auto first = along(upper, lower);
        const auto second = along(lower, end);
        if (!first || !second) return;
        const auto side = unit_across(towards, *first);
        if (!side) return;
        glm::dvec3 axis = glm::cross(*first, *side);
        const glm::dvec3 bend = swing_between(*first, *second);
        const double angle = glm::length(bend);
        // A limb that is clearly bent shows its axis. One that is bent elsewhere, or by that much to the wrong side, is
        // no human's.
        if (angle > kStrange) {
            const glm::dvec3 shown = bend / angle;
            if (glm::dot(shown, axis) < 0.5) return warn_of_strange_rest(lower);
            axis = shown;
        }
        if (!move_zero(ranges.z, glm::dot(bend, axis))) return warn_of_strange_rest(lower);
        propose_hinge(lower, axis, ranges.z);
        const auto z = unit_across(axis, *second);
        if (!z || limits_.empty() || limits_.back().joint != lower) return;
        const glm::dmat3 axes(*second, glm::cross(*z, *second), *z);
        limits_.back().looser = make_limit(lower, LimitModel::swing_twist_ellipse, axes, ranges);
    }

    void propose_hinge(std::uint32_t joint, glm::dvec3 axis, Range range) {
        if (joint == kNone) return;
        const glm::dvec3 other = std::abs(glm::dot(axis, stance_.up)) < 0.7 ? stance_.up : stance_.forward;
        const std::optional<glm::dvec3> y = unit_across(other, axis);
        if (y) add(joint, LimitModel::hinge, glm::dmat3(axis, *y, glm::cross(axis, *y)), {range, {}, {}});
    }

    void add(std::uint32_t joint, LimitModel model, const glm::dmat3& axes, const Ranges& ranges) {
        if (const auto limit = make_limit(joint, model, axes, ranges)) limits_.push_back({joint, *limit});
    }

    /// \param axes X, Y, Z of the limit's frame in model space
    [[nodiscard]] std::optional<LimitRecord> make_limit(std::uint32_t joint, LimitModel model, const glm::dmat3& axes,
                                                        const Ranges& ranges) const {
        const std::optional<glm::dquat> orientation = rest_.orientation(joint);
        if (!orientation) return std::nullopt;
        const glm::dquat frame = glm::normalize(glm::conjugate(*orientation) * rotation_of_axes(axes));
        LimitRecord limit;
        limit.model = static_cast<std::uint8_t>(model);
        limit.flags = kProposed;
        limit.frame = {static_cast<float>(frame.x), static_cast<float>(frame.y), static_cast<float>(frame.z),
                       static_cast<float>(frame.w)};
        const std::array<Range, 3> of_axis{ranges.x, ranges.y, ranges.z};
        for (std::size_t axis = 0; axis < limited_axes(model); ++axis) {
            limit.rotation_min[axis] = static_cast<float>(of_axis[axis].low * kDegree);
            limit.rotation_max[axis] = static_cast<float>(of_axis[axis].high * kDegree);
        }
        return limit;
    }

    void warn_of_strange_rest(std::uint32_t joint) {
        report_.warn("auto-rig: the rest pose is outside what a human can do, no limit proposed for this joint",
                     scene_.joints[joint].name);
    }

    const Scene& scene_;
    const RestFrames& rest_;
    const NamedHumanoid& found_;
    const Humanoid& bones_;
    const Stance& stance_;
    Report& report_;
    std::vector<ProposedLimit> limits_;
};

}  // namespace

std::vector<ProposedLimit> propose_limits(const Scene& scene, const RestFrames& rest, const NamedHumanoid& found,
                                          const Stance& stance, Report& report) {
    return Proposer(scene, rest, found, stance, report).propose();
}

}  // namespace bendy::converter
