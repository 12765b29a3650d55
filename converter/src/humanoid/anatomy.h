#pragma once

#include "clip_rotations.h"
#include "find_humanoid.h"
#include "limb_chains.h"
#include "rest_frames.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>
#include <bendy/format/records.h>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace bendy::converter {

/// Degrees.
struct Range {
    double low = 0.0;
    double high = 0.0;
};

/// About the axes of a limit's frame.
struct Ranges {
    Range x, y, z;
};

/// Which joint of a body it is, as proposals call it. The last five are those of an animal on four legs.
enum class BodyJoint : std::uint8_t {
    collarbone,
    shoulder,
    elbow,
    wrist,
    hip,
    knee,
    ankle,
    toes,
    spine,
    neck,
    tail,
    front_leg,        ///< where the leg leaves the trunk
    hind_leg,         ///< as front_leg
    front_leg_joint,  ///< one below: elbow, carpus, ...
    hind_leg_joint,   ///< one below: stifle, hock, ...
};

constexpr bool bends(BodyJoint joint) {
    return joint == BodyJoint::elbow || joint == BodyJoint::knee || joint == BodyJoint::toes ||
           joint == BodyJoint::front_leg_joint || joint == BodyJoint::hind_leg_joint;
}

/// The range of motion of one of the character's joints, relative to its rest pose.
struct JointAnatomy {
    std::uint32_t joint = kNone;
    BodyJoint part = BodyJoint::spine;
    bool is_right = false;
    std::uint8_t number = 0;  ///< of the joints that share the part, from the trunk or from below; 0: it is one
    /// X, Y, Z of the limit's frame in model space at rest. Elbows, knees and toes: X along the bone that turns, Z the
    /// axis of the bend. The others: X along the bone. The right side's frame is the left one's mirrored: a right joint
    /// does the same as a left one with the signs of X and Y changed where it bends, of X and Z elsewhere.
    glm::dmat3 axes{1.0};
    Ranges typical;           ///< about the neutral pose, in the left joint's signs turned to this side's
    Ranges widest;            ///< as far as clips may widen them
    glm::dvec3 rest{0.0};     ///< the rest pose: its angles away from the neutral one; of a bend a rotation vector
    bool is_strange = false;  ///< the rest pose is more than 10 degrees outside the typical ranges
};

/// Makes the anatomy of joints from where they rest.
class AnatomyBuilder {
public:
    AnatomyBuilder(const RestFrames& rest, const Stance& stance) : rest_(rest), stance_(stance) {}

    /// The side that the following joints are on: ranges are a left joint's.
    void set_side(bool is_right) { is_right_ = is_right; }

    /// Swing and twist with X along the bone and Z as near `z` as may be. Where a `neutral` direction is given the
    /// ranges are about the bone pointing there. \param number  JointAnatomy::number
    void add_swing(std::uint32_t joint, BodyJoint part, std::optional<glm::dvec3> x, glm::dvec3 z,
                   const Ranges& typical, std::optional<glm::dvec3> neutral = std::nullopt, std::size_t number = 0);

    /// The bend between two bones of a limb, of which the second ends at `end`. At rest it is bent by some angle
    /// already. \param towards  the side to which it bends
    void add_bend(std::uint32_t upper, std::uint32_t lower, BodyJoint part, std::optional<glm::dvec3> end,
                  glm::dvec3 towards, const Ranges& typical, std::size_t number = 0);

    /// Joints above one another that share a range; `next` follows the last one. Clips may give one of them all of the
    /// range. \param straight  the direction of a bone without a next one \param z  as of add_swing; if not given, at
    /// right angles to the bone and to the character's left-right axis
    void add_column(const std::vector<std::uint32_t>& joints, std::uint32_t next, BodyJoint part,
                    const Ranges& together, const glm::dvec3& straight, std::optional<glm::dvec3> z = std::nullopt);

    /// Adds a joint that bends about the character's left-right axis, as toes do.
    void add_toes(std::uint32_t joint, const Ranges& typical);

    /// How the second bone is turned from the first at rest: axis in model space times degrees.
    [[nodiscard]] std::optional<glm::dvec3> bend_between(std::uint32_t upper, std::uint32_t lower,
                                                         const glm::dvec3& end) const;

    /// From one joint to the other; nothing if one is missing.
    [[nodiscard]] std::optional<glm::dvec3> along(std::uint32_t from, std::uint32_t to) const;

    [[nodiscard]] std::vector<JointAnatomy> take() { return std::move(joints_); }

private:
    void add(std::uint32_t joint, BodyJoint part, const glm::dmat3& axes, const Ranges& typical, const glm::dvec3& rest,
             std::size_t number);
    [[nodiscard]] Ranges bend_of_side(const Ranges& left) const;

    const RestFrames& rest_;
    const Stance& stance_;
    bool is_right_ = false;
    std::vector<JointAnatomy> joints_;
};

/// A human's joints at this character: hinges for elbows, knees and toes, swing and twist for the others; spec/rig.md
/// has the ranges.
std::vector<JointAnatomy> find_anatomy(const Scene& scene, const RestFrames& rest, const NamedHumanoid& found,
                                       const Stance& stance);

/// The ranges away from the rest pose, which is inside.
Ranges ranges_from_rest(const Ranges& ranges, const glm::dvec3& rest);

/// Degrees that the rest pose is outside.
double outside(const Range& range, double rest);

struct ProposedConstraint {
    JointAnatomy anatomy;
    ConstraintRecord constraint;  ///< flagged kProposed
    glm::dvec3 axis{0.0};         ///< of a bend: about which it bends, in model space at rest
    std::uint32_t clips = 0;      ///< that turn this joint, or its counterpart, by 5 degrees or more in all
    bool is_axis_fitted = false;  ///< to the clips
    double axis_off = 0.0;        ///< degrees between the bend's axis and the one that the anatomy says
    double growth = 0.0;          ///< degrees by which the clips widen the typical range, at most of all ends
    double beyond = 0.0;          ///< degrees that the clips leave the range, beyond what they may widen it to
};

/// Limits for what joints can do, fitted to the scene's own clips. A bend's axis is the one about which they turn most.
/// Where they turn the joint about that axis alone, to a degree, it gets a hinge; else a swing and twist whose Z is the
/// bend. Ranges are the typical ones, widened to hold every key and what lies between, up to the widest ones. Both
/// sides have the same ranges, and mirrored axes where their clips and the rest pose let them. A joint that rests where
/// it cannot gets no limit, with a warning, unless clips move it.
std::vector<ProposedConstraint> fit_to_clips(const Scene& scene, const RestFrames& rest, const ClipRotations& clips,
                                             const std::vector<JointAnatomy>& anatomy, const glm::dvec3& left,
                                             Report& report);

}  // namespace bendy::converter
