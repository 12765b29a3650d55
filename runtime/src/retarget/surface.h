#pragma once

#include "body.h"
#include "shell.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace bendy {

struct PoseState;

/// Points of a body's skin that lie farthest in many directions.
struct SurfacePart {
    /// One joint's contribution to a point, as in skinning.
    struct Share {
        std::uint32_t joint = 0, point = 0;
        double weight = 1.0;
        glm::dvec3 place{0.0};  ///< in the space of the joint
    };
    std::vector<Share> shares;       ///< by joint
    std::vector<double> radii;       ///< metres: about each point
    std::vector<double> heights;     ///< work memory: of each point
    std::vector<glm::dvec3> points;  ///< work memory

    /// Returns the height of the lowest point along up, metres in model space; infinity without points.
    double lowest(PoseState& pose, const glm::dvec3& up);
    /// Returns where the points are in model space, until the next call.
    std::span<const glm::dvec3> places(PoseState& pose);
};

/// Where a human may touch the ground or itself.
struct Surface {
    SurfacePart body;                 ///< head, trunk, thighs and knees
    SurfacePart arms;                 ///< without hands
    std::array<SurfacePart, 4> ends;  ///< of the limbs, see Body::limbs: feet and hands
    std::array<Shell, 5> shells;      ///< what hands may touch: head, chest, belly with hips, thighs
    double floor = 0.0;               ///< metres along up, in model space: below the soles of who stands
};

/// Reads the skin. What hangs off the body, such as a cape or a skirt, does not count. A body without a skin has its
/// joints, each in a ball.
Surface find_surface(const Body& body);

}  // namespace bendy
