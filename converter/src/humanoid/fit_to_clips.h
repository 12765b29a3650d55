#pragma once

#include "anatomy.h"
#include "clip_rotations.h"
#include "rest_frames.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>
#include <bendy/format/records.h>

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace bendy::converter {

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
