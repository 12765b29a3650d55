#pragma once

#include "rest_frames.h"

#include <bendy/converter/scene.h>

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace bendy::converter {

/// By joint: its children among those of `chosen`, in the joints' order.
std::vector<std::vector<std::uint32_t>> list_children(const Scene& scene, const std::vector<bool>& chosen);

/// Joints of one side's limb and of the other's, from the trunk outward: each pair mirrored.
struct MirroredChains {
    std::array<std::vector<std::uint32_t>, 2> joints;
    glm::dvec3 across{1.0, 0.0, 0.0};  ///< unit, from the second to the first
    std::size_t splits_at = 0;         ///< where it branches into several, as a hand into fingers; 0: nowhere
};

/// All pairs of limbs with a common parent that are each other's mirror images and have at least three joints.
/// \param chosen  by joint: only these are looked at
std::vector<MirroredChains> find_mirrored_chains(const Scene& scene, const RestFrames& rest,
                                                 const std::vector<bool>& chosen);

/// The nearest joint that all of these are below; kNone if there is none, or nothing is given.
std::uint32_t common_ancestor(const Scene& scene, const RestFrames& rest, const std::vector<std::uint32_t>& joints);

}  // namespace bendy::converter
