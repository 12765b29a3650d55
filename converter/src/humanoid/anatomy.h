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

#include <cstdint>
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

/// Which joint of a human's it is: what the proposals call it.
enum class HumanJoint : std::uint8_t {
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
};

constexpr bool bends(HumanJoint joint) {
    return joint == HumanJoint::elbow || joint == HumanJoint::knee || joint == HumanJoint::toes;
}

/// What a human could do with a joint, at this character's joint, as it rests.
struct JointAnatomy {
    std::uint32_t joint = kNone;
    HumanJoint part = HumanJoint::spine;
    bool is_right = false;
    std::uint8_t number = 0;  ///< of the joints that share the part, from below; 0: it is one
    /// X, Y, Z of the limit's frame in model space at rest. Elbows, knees and toes: X along the bone that turns, Z the
    /// axis of the bend. The others: X along the bone. The right side's frame is the left one's mirrored: a right joint
    /// does the same as a left one with the signs of X and Y changed where it bends, of X and Z elsewhere.
    glm::dmat3 axes{1.0};
    Ranges human;             ///< about the neutral pose, in the left joint's signs turned to this side's
    glm::dvec3 rest{0.0};     ///< the rest pose: its angles away from the neutral one; of a bend a rotation vector
    bool is_strange = false;  ///< the rest pose is more than 10 degrees outside what a human can do
};

/// A human's joints at this character: hinges for elbows, knees and toes, swing and twist for the others; spec/rig.md
/// has the ranges.
std::vector<JointAnatomy> find_anatomy(const Scene& scene, const RestFrames& rest, const NamedHumanoid& found,
                                       const Stance& stance);

/// The ranges away from the rest pose, which is inside.
Ranges ranges_from_rest(const Ranges& human, const glm::dvec3& rest);

/// Degrees that the rest pose is outside.
double outside(const Range& range, double rest);

struct ProposedConstraint {
    JointAnatomy anatomy;
    ConstraintRecord constraint;  ///< flagged kProposed
    glm::dvec3 axis{0.0};         ///< of a bend: about which it bends, in model space at rest
    std::uint32_t clips = 0;      ///< that turn this joint, or its counterpart, by 5 degrees or more in all
    bool is_axis_fitted = false;  ///< to the clips
    double axis_off = 0.0;        ///< degrees between the bend's axis and the one that the anatomy says
    double growth = 0.0;          ///< degrees that the clips take it beyond a human's range, at most of all ends
};

/// Limits for what a human's joints can do, held against the scene's own clips: what the clips do decides. A bend's
/// axis is fitted to them: the one about which they turn most. Where they turn the joint about that axis alone, to a
/// degree, it gets a hinge; else a swing and twist whose Z is the bend. Ranges are a human's, widened to hold every
/// key and what lies between. Both sides have the same ranges, and mirrored axes where their clips and the rest pose
/// let them. A joint that rests where a human's cannot gets no limit, with a warning, unless clips move it.
std::vector<ProposedConstraint> fit_to_clips(const Scene& scene, const RestFrames& rest, const ClipRotations& clips,
                                             const std::vector<JointAnatomy>& anatomy, const glm::dvec3& left,
                                             Report& report);

}  // namespace bendy::converter
