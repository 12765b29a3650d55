#pragma once

#include "limit_chart.h"

#include <bendy/runtime/constraint.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>

namespace bendy {

/// Links of an arm or a leg, which retargeting moves whether the model has a chain for it or not.
inline constexpr std::uint32_t kLimbLinks = 3;

/// A way in which a link can turn, at right angles to its others as their cost measures it, and of unit cost.
struct IkWay {
    LimitChart::Numbers numbers;
    glm::dvec3 axis;  ///< of the rotation that this makes
};

/// A joint of a chain while an IK solver works on it; a PoseState has enough for its model's longest chain, so that
/// reaching allocates nothing. Rotations and bones are in the space of the start's parent, lengths in chain lengths.
struct IkLink {
    glm::dquat local;                        ///< relative to the previous link
    glm::dvec3 bone;                         ///< to the next link or the tip, relative to this link
    glm::dquat rest_frame;                   ///< q_rest * C
    glm::dquat frame;                        ///< C
    const Constraint* constraint = nullptr;  ///< null: free
    glm::dvec3 freedom{1};                   ///< 0 to 1 about the frame's axes: weight * (1 - stiffness)
    double bone_length = 0.0;
    // Only in a chain whose scales are uneven; the bone is then that of the chain as it is placed.
    glm::dmat3 shape;  ///< the joint's scale and shear
    glm::dvec3 end;    ///< to the next link or the tip, before that
    std::uint32_t joint = 0;
    bool is_fixed = false;  ///< no freedom about any axis

    // Computed by the problem's `place`.
    glm::dquat global;
    glm::dvec3 position;
    glm::dmat3 space;  ///< of a chain whose scales are uneven: from the parent's space to base space
    glm::dvec3 arm;    ///< of such a chain: to the tip, in the parent's space

    // Used by the solvers.
    glm::dquat saved;  ///< a saved rotation; at first that of the pose that came in, legal or not
    LimitChart chart;
    glm::dquat before;  ///< a step, and the numbers
    LimitChart::Numbers numbers_before;
    std::size_t way_count = 0;
    std::array<IkWay, 3> ways;  ///< of a damped step
    glm::dmat3 mobility;        ///< from a torque to a turn
    glm::dquat legal;           ///< as it came in, moved inside the limits
    glm::dquat closed;          ///< in the closed form
    glm::dquat best;
};

}  // namespace bendy
