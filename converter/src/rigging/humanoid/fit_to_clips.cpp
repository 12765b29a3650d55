#include "anatomy.h"

#include <bendy/format/constraint.h>
#include <bendy/format/trig.h>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace bendy::converter {
namespace {

constexpr double kStill = 5.0;    // degrees: clips that turn a joint by less do not show an axis
constexpr double kWobble = 1.0;   // degrees: largest deviation of a hinge from its axis
constexpr double kMargin = 0.25;  // degrees beyond the clips
constexpr double kAlike = 10.0;   // largest degrees between one side and the other one's mirror image

Range united(const Range& a, const Range& b) {
    return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

Range shifted(const Range& range, double by) {
    return {range.low + by, range.high + by};
}

Range mirrored(const Range& range) {
    return {-range.high, -range.low};
}

/// One joint, in the signs of a left one.
struct Member {
    const JointAnatomy* anatomy = nullptr;
    glm::dvec3 rest{0.0};
    Ranges typical, widest;
    Rotations rotations;  ///< R in the frame of the anatomy's axes
    std::uint32_t clips = 0;

    [[nodiscard]] bool bends() const { return converter::bends(anatomy->part); }
    /// Converts a vector of the frame between the sides' signs; its own inverse.
    [[nodiscard]] glm::dvec3 to_side(const glm::dvec3& v) const {
        if (!anatomy->is_right) return v;
        return bends() ? glm::dvec3(-v.x, -v.y, v.z) : glm::dvec3(-v.x, v.y, -v.z);
    }
    [[nodiscard]] Ranges to_side(const Ranges& r) const {
        if (!anatomy->is_right) return r;
        return bends() ? Ranges{mirrored(r.x), mirrored(r.y), r.z} : Ranges{mirrored(r.x), r.y, mirrored(r.z)};
    }
};

/// The axis and range of a joint's bend.
struct BendFit {
    bool moves = false;  ///< the clips turn it by 5 degrees or more
    bool is_hinge = true;
    bool is_fitted = false;  ///< the axis comes from the clips, not the anatomy
    glm::dvec3 axis{0.0, 0.0, 1.0};
    Range bend;  ///< relative to the rest pose
    Range x, y;  ///< twist, and sideways; only if not a hinge
};

/// Orients the axis so that the usual bend is positive, unless the clips bend the joint the other way.
glm::dvec3 with_sign(glm::dvec3 axis, const Rotations& rotations, const glm::dvec3& rest) {
    constexpr double kClearly = 45.0;  // degrees
    if (axis.z < 0.0) axis = -axis;
    Range bend{0.0, 0.0};
    for (const glm::dquat& r : rotations) {
        const double angle = angle_about(r, axis) + glm::dot(rest, axis);
        bend = united(bend, {angle, angle});
    }
    const bool is_sideways = axis.z < 0.5;
    const bool is_back = -bend.low > (is_sideways ? bend.high : std::max(kClearly, 3.0 * bend.high));
    return is_back ? -axis : axis;
}

/// \param axis   of the bend; at right angles to X if the joint is not a hinge
BendFit measure_bend(BendFit fit, const Rotations& rotations) {
    const glm::dvec3 y = glm::cross(fit.axis, {1.0, 0.0, 0.0});
    for (const glm::dquat& r : rotations) {
        double angle = angle_about(r, fit.axis);
        if (!fit.is_hinge) {
            const SwingTwist parts = decompose(r);
            const glm::dvec3 swing(0.0, parts.swing.x, parts.swing.y);
            angle = 2.0 * trig::atan2(glm::dot(swing, fit.axis), parts.cosine) / trig::kDegree;
            const double sideways = 2.0 * trig::atan2(glm::dot(swing, y), parts.cosine) / trig::kDegree;
            fit.x = united(fit.x, {parts.twist, parts.twist});
            fit.y = united(fit.y, {sideways, sideways});
        }
        fit.bend = united(fit.bend, {angle, angle});
    }
    return fit;
}

BendFit fit_hinge(const Rotations& rotations, const glm::dvec3& rest) {
    BendFit fit;
    fit.moves = largest_angle(rotations) >= kStill;
    if (fit.moves) {
        const glm::dvec3 axis = fit_axis(rotations);
        fit.is_fitted = std::abs(axis.x) < 0.7;
        if (fit.is_fitted) fit.axis = with_sign(axis, rotations, rest);
    }
    fit.is_hinge = wobble_about(rotations, fit.axis) <= kWobble;
    return measure_bend(fit, rotations);
}

BendFit fit_swing(const Rotations& rotations, const glm::dvec3& rest) {
    BendFit fit;
    fit.is_hinge = false;
    fit.moves = largest_angle(rotations) >= kStill;
    double most = 0.0;
    for (const glm::dquat& r : rotations) most = std::max(most, degrees_of(glm::length(decompose(r).swing)));
    if (most >= 2.0 * kStill) {
        fit.axis = with_sign(fit_swing_axis(rotations), rotations, rest);
        fit.is_fitted = true;
    }
    return measure_bend(fit, rotations);
}

/// The ellipse of a swing: sines of half the angles, about Y and Z, below and above 0.
class Ellipse {
public:
    Ellipse(const Range& y, const Range& z)
        : sides_{{{half_sine_of(-y.low), half_sine_of(y.high)}, {half_sine_of(-z.low), half_sine_of(z.high)}}} {}

    /// Widens the ellipse until it includes all rotations: first each half axis, then the quadrants.
    void embrace(const Rotations& rotations) {
        for (const glm::dquat& r : rotations) {
            const glm::dvec2 swing = decompose(r).swing;
            for (int axis = 0; axis < 2; ++axis) {
                double& side = this->side(axis, swing);
                side = std::min(1.0, std::max(side, std::abs(swing[axis])));
            }
        }
        for (int round = 0; round < 3; ++round) {
            std::array<std::array<double, 2>, 2> factors{{{1.0, 1.0}, {1.0, 1.0}}};
            for (const glm::dquat& r : rotations) {
                const glm::dvec2 swing = decompose(r).swing;
                const double size = std::sqrt(square(swing));
                if (!(size > 1.0)) continue;
                for (int axis = 0; axis < 2; ++axis) {
                    double& factor = factors[static_cast<std::size_t>(axis)][swing[axis] > 0.0 ? 1 : 0];
                    factor = std::max(factor, size);
                }
            }
            for (std::size_t axis = 0; axis < 2; ++axis) {
                for (const std::size_t end : {0u, 1u})
                    sides_[axis][end] = std::min(1.0, sides_[axis][end] * factors[axis][end]);
            }
        }
        // A half axis stops growing at half a turn; then the other one grows to it as well.
        for (const glm::dquat& r : rotations) {
            const glm::dvec2 swing = decompose(r).swing;
            if (!(square(swing) > 1.0 + 1e-9)) continue;
            for (int axis = 0; axis < 2; ++axis) side(axis, swing) = 1.0;
        }
    }

    [[nodiscard]] Range range(std::size_t axis) const {
        return {-degrees_of(sides_[axis][0]), degrees_of(sides_[axis][1])};
    }
    [[nodiscard]] bool holds(const glm::dvec2& swing) { return square(swing) <= 1.0; }

private:
    double& side(int axis, const glm::dvec2& swing) {
        return sides_[static_cast<std::size_t>(axis)][swing[axis] > 0.0 ? 1 : 0];
    }
    double square(const glm::dvec2& swing) {
        double sum = 0.0;
        for (int axis = 0; axis < 2; ++axis) {
            if (std::abs(swing[axis]) < 1e-9) continue;
            const double part = swing[axis] / side(axis, swing);
            sum += part * part;
        }
        return sum;
    }

    std::array<std::array<double, 2>, 2> sides_;
};

/// The pyramid of a swing: independent ranges of the angles about Y and Z.
class Pyramid {
public:
    Pyramid(const Range& y, const Range& z) : ranges_{y, z} {}

    void embrace(const Rotations& rotations) {
        for (const glm::dquat& r : rotations) {
            const SwingTwist parts = decompose(r);
            for (int axis = 0; axis < 2; ++axis) {
                const double angle = angle_of(parts.swing[axis], parts.cosine);
                Range& range = ranges_[static_cast<std::size_t>(axis)];
                if (angle < range.low) range.low = angle - kMargin;
                if (angle > range.high) range.high = angle + kMargin;
            }
        }
    }

    [[nodiscard]] Range range(std::size_t axis) const { return ranges_[axis]; }
    [[nodiscard]] bool holds(const glm::dvec2& swing) const {
        const double cosine = std::sqrt(std::max(0.0, 1.0 - glm::dot(swing, swing)));
        for (int axis = 0; axis < 2; ++axis) {
            const Range& range = ranges_[static_cast<std::size_t>(axis)];
            const double angle = angle_of(swing[axis], cosine);
            if (angle < range.low || angle > range.high) return false;
        }
        return true;
    }

private:
    static double angle_of(double sine, double cosine) { return 2.0 * trig::atan2(sine, cosine) / trig::kDegree; }

    std::array<Range, 2> ranges_;
};

/// Measures how much of the sphere of directions a shape allows; swing vectors are its equal-area map.
template <class Shape>
int count_directions(Shape& shape) {
    constexpr int kSteps = 32;
    int count = 0;
    for (int y = -kSteps; y <= kSteps; ++y) {
        for (int z = -kSteps; z <= kSteps; ++z) {
            const glm::dvec2 swing(static_cast<double>(y) / kSteps, static_cast<double>(z) / kSteps);
            count += glm::dot(swing, swing) <= 1.0 && shape.holds(swing) ? 1 : 0;
        }
    }
    return count;
}

/// A pair of counterpart joints of both sides, or a single joint.
class Group {
public:
    Group(const Scene& scene, const RestFrames& rest, const glm::dvec3& left)
        : scene_(scene), rest_(rest), left_(left) {}

    void add(const JointAnatomy& anatomy, const ClipRotations& clips) {
        Member member;
        member.anatomy = &anatomy;
        member.rest = member.to_side(anatomy.rest);
        member.typical = member.to_side(anatomy.typical);
        member.widest = member.to_side(anatomy.widest);
        const glm::dquat frame = frame_of(anatomy.joint, anatomy.axes);
        ClipRotations::OfJoint turns = clips.of(anatomy.joint);
        member.clips = turns.clips;
        member.rotations = std::move(turns.rotations);
        for (glm::dquat& r : member.rotations) {
            r = glm::conjugate(frame) * r * frame;
            const glm::dvec3 v = member.to_side(glm::dvec3(r.x, r.y, r.z));
            r = glm::dquat(r.w, v);
        }
        members_.push_back(std::move(member));
    }

    [[nodiscard]] std::vector<ProposedConstraint> fit(const ClipRotations& clips, Report& report) {
        mesh();
        bool moves = false;
        for (const Member& member : members_) moves = moves || largest_angle(member.rotations) >= kStill;
        std::vector<ProposedConstraint> constraints;
        for (const Member& member : members_) {
            if (member.anatomy->is_strange && !moves) {
                report.warn(
                    "auto-rig: the rest pose is outside what such a joint can do and no clip moves the joint, no limit "
                    "proposed for it",
                    scene_.joints[member.anatomy->joint].name);
                continue;
            }
            ProposedConstraint proposed;
            proposed.anatomy = *member.anatomy;
            if (moves) proposed.clips = clips_;
            constraints.push_back(proposed);
        }
        if (constraints.empty()) return constraints;
        if (members_.front().bends()) {
            fit_bends(constraints);
        } else {
            fit_swings(constraints);
        }
        std::vector<std::uint32_t> joints;
        for (const Member& member : members_) joints.push_back(member.anatomy->joint);
        for (ProposedConstraint& constraint : constraints) {
            if (constraint.beyond > 0.0) constraint.farthest_clip = clips.farthest_clip(joints);
        }
        return constraints;
    }

private:
    [[nodiscard]] glm::dquat frame_of(std::uint32_t joint, const glm::dmat3& axes) const {
        return glm::normalize(glm::conjugate(*rest_.turning_axes(joint)) * rotation_of_axes(axes));
    }

    [[nodiscard]] const Member& member_of(const ProposedConstraint& constraint) const {
        return *std::find_if(members_.begin(), members_.end(),
                             [&](const Member& member) { return member.anatomy->joint == constraint.anatomy.joint; });
    }

    /// Whether the sides' rest poses mirror each other.
    [[nodiscard]] bool are_alike() const {
        const double least = trig::sin_cos((90.0 - kAlike) * trig::kDegree).sin;  // cosine
        const JointAnatomy& a = *members_[0].anatomy;
        const JointAnatomy& b = *members_[1].anatomy;
        const auto mirror = [&](const glm::dvec3& v) { return v - 2.0 * glm::dot(v, left_) * left_; };
        const glm::dvec3 z = mirror(a.axes[2]) * (members_[0].bends() ? -1.0 : 1.0);
        return glm::dot(mirror(a.axes[0]), b.axes[0]) > least && glm::dot(z, b.axes[2]) > least &&
               glm::length(members_[0].rest - members_[1].rest) < kAlike;
    }

    void mesh() {
        for (const Member& member : members_) clips_ = std::max(clips_, member.clips);
        is_pooled_ = members_.size() == 1 || are_alike();
        if (!is_pooled_) return;
        for (const Member& member : members_) {
            pooled_.insert(pooled_.end(), member.rotations.begin(), member.rotations.end());
            pooled_rest_ += member.rest / static_cast<double>(members_.size());
        }
    }

    // --- elbows, knees, toes

    [[nodiscard]] std::vector<BendFit> fit_each(BendFit (*fit_one)(const Rotations&, const glm::dvec3&)) const {
        std::vector<BendFit> fits;
        for (const Member& member : members_) fits.push_back(fit_one(member.rotations, member.rest));
        if (fits.size() == 2) {  // one that does not move adopts the other's
            for (const std::size_t still : {0u, 1u}) {
                const BendFit& other = fits[1 - still];
                if (fits[still].is_fitted || !other.is_fitted || fits[still].moves) continue;
                BendFit learned;
                learned.is_hinge = other.is_hinge && wobble_about(members_[still].rotations, other.axis) <= kWobble;
                learned.is_fitted = true;
                learned.axis = other.axis;
                fits[still] = measure_bend(learned, members_[still].rotations);
            }
        }
        return fits;
    }

    [[nodiscard]] std::vector<BendFit> choose_fits() const {
        const auto are_hinges = [](const std::vector<BendFit>& fits) {
            return std::all_of(fits.begin(), fits.end(), [](const BendFit& fit) { return fit.is_hinge; });
        };
        if (is_pooled_) {
            std::vector<BendFit> same(members_.size(), fit_hinge(pooled_, pooled_rest_));
            if (are_hinges(same)) return same;
        }
        std::vector<BendFit> own = fit_each(fit_hinge);
        if (are_hinges(own)) return own;
        if (!is_pooled_) return fit_each(fit_swing);
        std::vector<BendFit> same(members_.size(), fit_swing(pooled_, pooled_rest_));
        return same;
    }

    void fit_bends(std::vector<ProposedConstraint>& constraints) {
        const std::vector<BendFit> fits = choose_fits();
        // The union of both sides, relative to the straight limb.
        Range bend = members_.front().typical.z;
        Range twist = members_.front().typical.x;
        Range sideways = members_.front().typical.y;
        for (std::size_t i = 0; i < members_.size(); ++i) {
            const Range moved = shifted(fits[i].bend, glm::dot(members_[i].rest, fits[i].axis));
            if (members_[i].clips > 0) bend = united(bend, with_margin(moved, bend));
            twist = united(twist, with_margin(fits[i].x, twist));
            sideways = united(sideways, with_margin(fits[i].y, sideways));
        }
        for (ProposedConstraint& constraint : constraints) {
            const Member& member = member_of(constraint);
            const BendFit& fit = fits[static_cast<std::size_t>(&member - members_.data())];
            const glm::dvec3 axis = member.to_side(fit.axis);
            constraint.axis = glm::normalize(constraint.anatomy.axes * axis);
            constraint.is_axis_fitted = fit.is_fitted;
            constraint.axis_off = degrees_of(0.5 * glm::length(constraint.axis - constraint.anatomy.axes[2]));
            const double rest_bend = glm::dot(member.rest, fit.axis);
            constraint.straight = -rest_bend;
            Range range = shifted(bend, -rest_bend);
            const glm::dvec3 rest(0.0, 0.0, rest_bend);
            const Range typical = ranges_from_rest(member.typical, rest).z;
            const Range widest = ranges_from_rest(member.widest, rest).z;
            range = cut({std::min(range.low, 0.0), std::max(range.high, 0.0)}, widest, constraint);
            constraint.growth = std::max({typical.low - range.low, range.high - typical.high, 0.0});
            range = whole(range, typical);
            if (fit.is_hinge) {
                const glm::dvec3 along = constraint.anatomy.axes[0];
                const auto z = unit_across(along, constraint.axis);
                const glm::dmat3 axes(constraint.axis, glm::cross(*z, constraint.axis), *z);
                set(constraint, ConstraintModel::hinge, axes, {range, {}, {}});
                continue;
            }
            const glm::dmat3 axes(constraint.anatomy.axes[0], glm::cross(constraint.axis, constraint.anatomy.axes[0]),
                                  constraint.axis);
            const Ranges side = member.to_side(
                Ranges{cut(twist, member.widest.x, constraint), cut(sideways, member.widest.y, constraint), {}});
            set(constraint, ConstraintModel::swing_twist_pyramid, axes,
                {whole(side.x, {}), whole(side.y, {}), {std::max(range.low, -179.0), std::min(range.high, 179.0)}});
            // A straight limb's preferred angle: the bend it takes most readily.
            constraint.constraint.preferred[2] =
                static_cast<float>(std::clamp(30.0, range.low, range.high) * trig::kDegree);
        }
    }

    // --- other joints

    void fit_swings(std::vector<ProposedConstraint>& constraints) {
        // Prefer an ellipse, as in real joints, unless the clips make it allow much more than a pyramid would.
        std::vector<Ellipse> ellipses;
        std::vector<Pyramid> pyramids;
        int of_ellipses = 0;
        int of_pyramids = 0;
        Range twist = members_.front().typical.x;
        for (const Member& member : members_) {
            const Rotations& rotations = is_pooled_ ? pooled_ : member.rotations;
            const Ranges ranges = ranges_from_rest(member.typical, member.rest);
            ellipses.emplace_back(ranges.y, ranges.z).embrace(rotations);
            pyramids.emplace_back(ranges.y, ranges.z).embrace(rotations);
            of_ellipses += count_directions(ellipses.back());
            of_pyramids += count_directions(pyramids.back());
            for (const glm::dquat& r : rotations) {
                const double angle = decompose(r).twist;
                twist = united(twist, with_margin({angle, angle}, twist));
            }
        }
        // Also use a pyramid if the ellipse would exceed the widest ranges: a pyramid's ranges are independent.
        bool is_pyramid = 10 * of_pyramids < 9 * of_ellipses;
        for (std::size_t i = 0; i < members_.size(); ++i) {
            const Ranges widest = ranges_from_rest(members_[i].widest, members_[i].rest);
            for (const auto& [axis, most] : {std::pair(0u, widest.y), std::pair(1u, widest.z)}) {
                const Range range = ellipses[i].range(axis);
                is_pyramid = is_pyramid || range.low < most.low || range.high > most.high;
            }
        }
        std::array<Range, 2> swing{members_.front().typical.y, members_.front().typical.z};
        for (std::size_t i = 0; i < members_.size(); ++i) {
            for (const std::size_t axis : {0u, 1u}) {
                const Range range = is_pyramid ? pyramids[i].range(axis) : ellipses[i].range(axis);
                const glm::dvec3& rest_pose = members_[i].rest;
                swing[axis] = united(swing[axis], shifted(range, axis == 0 ? rest_pose.y : rest_pose.z));
            }
        }
        const ConstraintModel model =
            is_pyramid ? ConstraintModel::swing_twist_pyramid : ConstraintModel::swing_twist_ellipse;
        for (ProposedConstraint& constraint : constraints) {
            const Member& member = member_of(constraint);
            const Ranges typical = ranges_from_rest(member.typical, member.rest);
            const Ranges widest = ranges_from_rest(member.widest, member.rest);
            const auto fitted = [&](const Range& range, const Range& usual, const Range& most) {
                const Range now = whole(cut(range, most, constraint), usual);
                constraint.growth = std::max({constraint.growth, usual.low - now.low, now.high - usual.high});
                return now;
            };
            const Ranges ranges{fitted(twist, typical.x, widest.x),
                                fitted(shifted(swing[0], -member.rest.y), typical.y, widest.y),
                                fitted(shifted(swing[1], -member.rest.z), typical.z, widest.z)};
            set(constraint, model, constraint.anatomy.axes, member.to_side(ranges));
        }
    }

    // --- records

    [[nodiscard]] static Range with_margin(const Range& moved, const Range& typical) {
        return {moved.low < typical.low ? moved.low - kMargin : moved.low,
                moved.high > typical.high ? moved.high + kMargin : moved.high};
    }

    /// Clamps a range to the widest one, and records the excess in the constraint.
    [[nodiscard]] static Range cut(const Range& range, const Range& widest, ProposedConstraint& constraint) {
        constraint.beyond = std::max({constraint.beyond, widest.low - range.low, range.high - widest.high});
        return {std::max(range.low, widest.low), std::min(range.high, widest.high)};
    }

    /// Rounds ends that have changed outward to whole degrees.
    [[nodiscard]] static Range whole(const Range& range, const Range& before) {
        constexpr double kSame = 1e-6;
        return {range.low < before.low - kSame ? std::max(std::floor(range.low), -180.0) : before.low,
                range.high > before.high + kSame ? std::min(std::ceil(range.high), 180.0) : before.high};
    }

    void set(ProposedConstraint& proposed, ConstraintModel model, const glm::dmat3& axes, const Ranges& ranges) const {
        const glm::dquat frame = frame_of(proposed.anatomy.joint, axes);
        ConstraintRecord& constraint = proposed.constraint;
        constraint.model = static_cast<std::uint8_t>(model);
        constraint.flags = kProposed;
        constraint.frame = to_record(frame);
        const std::array<Range, 3> of_axis{ranges.x, ranges.y, ranges.z};
        for (std::size_t axis = 0; axis < limited_axes(model); ++axis) {
            constraint.rotation_min[axis] = static_cast<float>(of_axis[axis].low * trig::kDegree);
            constraint.rotation_max[axis] = static_cast<float>(of_axis[axis].high * trig::kDegree);
        }
    }

    const Scene& scene_;
    const RestFrames& rest_;
    glm::dvec3 left_;
    std::vector<Member> members_;
    std::uint32_t clips_ = 0;
    bool is_pooled_ = true;
    Rotations pooled_;
    glm::dvec3 pooled_rest_{0.0};
};

}  // namespace

std::vector<ProposedConstraint> fit_to_clips(const Scene& scene, const RestFrames& rest, const ClipRotations& clips,
                                             const std::vector<JointAnatomy>& anatomy, const glm::dvec3& left,
                                             Report& report) {
    std::vector<ProposedConstraint> constraints;
    std::vector<bool> is_done(anatomy.size());
    for (std::size_t i = 0; i < anatomy.size(); ++i) {
        if (is_done[i]) continue;
        Group group(scene, rest, left);
        for (std::size_t j = i; j < anatomy.size(); ++j) {
            const bool is_counterpart = anatomy[j].part == anatomy[i].part && anatomy[j].number == anatomy[i].number &&
                                        anatomy[j].is_right != anatomy[i].is_right;
            if (j != i && !is_counterpart) continue;
            group.add(anatomy[j], clips);
            is_done[j] = true;
            if (j != i) break;
        }
        for (const ProposedConstraint& constraint : group.fit(clips, report)) constraints.push_back(constraint);
    }
    return constraints;
}

}  // namespace bendy::converter
