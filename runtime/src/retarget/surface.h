#pragma once

#include "body.h"
#include "shell.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
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

/// Head, chest, belly with hips, and thighs.
inline constexpr std::size_t kBodyShells = 5;
/// So many props count.
inline constexpr std::size_t kMostProps = 4;

/// Where a human may touch the ground, itself, or what it holds.
struct Surface {
    SurfacePart body;                 ///< head, trunk, thighs and knees
    SurfacePart arms;                 ///< without hands
    std::array<SurfacePart, 4> ends;  ///< of the limbs, see Body::limbs: feet and hands
    std::vector<Shell> shells;        ///< what hands may touch: kBodyShells parts of the body, then props
    double floor = 0.0;               ///< metres along up, in model space: below the soles of who stands
};

/// Reads the skin. What hangs off the body, such as a cape or a skirt, does not count. A body without a skin has its
/// joints, each in a ball.
/// \param props  joints in hands, at most kMostProps; one without a skin has a shell without a joint
Surface find_surface(const Body& body, std::span<const std::uint32_t> props);

}  // namespace bendy
