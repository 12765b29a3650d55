#pragma once

#include "clip_rotations.h"
#include "find_humanoid.h"
#include "limb_chains.h"
#include "scene/rest_frames.h"

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

/// Ranges about the axes of a limit's frame.
struct Ranges {
    Range x, y, z;
};

/// The kind of body joint, as proposals name it. The last five belong to four-legged animals.
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
    std::uint8_t number = 0;  ///< among the joints of this part, from the trunk or from below; 0: the only one
    /// X, Y, Z of the limit's frame in model space at rest. Elbows, knees and toes: X along the bone that turns, Z the
    /// axis of the bend. Others: X along the bone. The right side's frame mirrors the left one: a right joint does the
    /// same as a left one with the signs of X and Y flipped for bends, of X and Z otherwise.
    glm::dmat3 axes{1.0};
    Ranges typical;           ///< about the neutral pose; a left joint's, with signs flipped for the right side
    Ranges widest;            ///< the most that clips may widen them to
    glm::dvec3 rest{0.0};     ///< the rest pose as angles from the neutral one; for a bend, a rotation vector
    bool is_strange = false;  ///< the rest pose is more than 10 degrees outside the typical ranges
};

/// Builds the anatomy of joints from their rest positions.
class AnatomyBuilder {
public:
    AnatomyBuilder(const RestFrames& rest, const Stance& stance) : rest_(rest), stance_(stance) {}

    /// Sets the side of the following joints; ranges are given for the left side.
    void set_side(bool is_right) { is_right_ = is_right; }

    /// Adds a swing and twist with X along the bone and Z as close to `z` as possible. With a `neutral` direction, the
    /// ranges are about the bone pointing there.
    /// \param number  JointAnatomy::number
    void add_swing(std::uint32_t joint, BodyJoint part, std::optional<glm::dvec3> x, glm::dvec3 z,
                   const Ranges& typical, std::optional<glm::dvec3> neutral = std::nullopt, std::size_t number = 0);

    /// Adds the bend between two bones of a limb; the second ends at `end`. It may already be bent at rest.
    /// \param towards  the side to which it bends
    void add_bend(std::uint32_t upper, std::uint32_t lower, BodyJoint part, std::optional<glm::dvec3> end,
                  glm::dvec3 towards, const Ranges& typical, std::size_t number = 0);

    /// Adds a chain of joints that share a range; `next` follows the last one. Clips may use up the whole range in one
    /// joint.
    /// \param straight  the direction of a bone that has no next joint
    /// \param z         as in add_swing; by default at right angles to the bone and to the character's left-right axis
    void add_column(const std::vector<std::uint32_t>& joints, std::uint32_t next, BodyJoint part,
                    const Ranges& together, const glm::dvec3& straight, std::optional<glm::dvec3> z = std::nullopt);

    /// Adds a joint that bends about the character's left-right axis, as toes do.
    void add_toes(std::uint32_t joint, const Ranges& typical);

    /// The rest rotation from the first bone to the second: axis in model space times degrees.
    [[nodiscard]] std::optional<glm::dvec3> bend_between(std::uint32_t upper, std::uint32_t lower,
                                                         const glm::dvec3& end) const;

    /// The direction from one joint to the other; nothing if one is missing.
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

/// The anatomy of this character's human joints: hinges for elbows, knees and toes, swing and twist for the others;
/// spec/rig.md lists the ranges.
std::vector<JointAnatomy> find_anatomy(const Scene& scene, const RestFrames& rest, const NamedHumanoid& found,
                                       const Stance& stance);

/// Converts ranges to angles from the rest pose, which they include.
Ranges ranges_from_rest(const Ranges& ranges, const glm::dvec3& rest);

/// Degrees by which the rest pose lies outside the range.
double outside(const Range& range, double rest);

struct ProposedConstraint {
    JointAnatomy anatomy;
    ConstraintRecord constraint;  ///< flagged kProposed
    glm::dvec3 axis{0.0};         ///< of a bend, in model space at rest
    double straight = 0.0;        ///< of a bend: degrees from the rest pose to the straight limb
    std::uint32_t clips = 0;      ///< that turn this joint, or its counterpart, by 5 degrees or more in total
    bool is_axis_fitted = false;  ///< the axis comes from the clips
    double axis_off = 0.0;        ///< degrees between the bend's axis and the anatomical one
    double growth = 0.0;          ///< largest number of degrees by which the clips widen the typical range at one end
    double beyond = 0.0;          ///< degrees by which the clips exceed the widest allowed range
    std::optional<std::size_t> farthest_clip;  ///< of those that exceed it, the one that turns the joint farthest
};

/// Proposes limits from the joints' anatomy, fitted to the scene's own clips. A bend's axis is the one about which the
/// clips turn the joint most. If they turn it about that axis alone, within a degree, it gets a hinge; otherwise a
/// swing and twist whose Z is the bend. Ranges are the typical ones, widened to include every key and the motion
/// between keys, up to the widest ones. Both sides get the same ranges, and mirrored axes if their clips and the rest
/// pose allow. A joint whose rest pose is anatomically impossible gets no limit, with a warning, unless clips move it.
std::vector<ProposedConstraint> fit_to_clips(const Scene& scene, const RestFrames& rest, const ClipRotations& clips,
                                             const std::vector<JointAnatomy>& anatomy, const glm::dvec3& left,
                                             Report& report);

}  // namespace bendy::converter
