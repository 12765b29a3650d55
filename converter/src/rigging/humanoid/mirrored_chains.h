#pragma once

#include "scene/rest_frames.h"

#include <bendy/converter/scene.h>

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace bendy::converter {

/// By joint: its `chosen` children, in the joints' order.
std::vector<std::vector<std::uint32_t>> list_children(const Scene& scene, const std::vector<bool>& chosen);

/// Joints of one side's limb and of the other's, from the trunk outward, in mirrored pairs.
struct MirroredChains {
    std::array<std::vector<std::uint32_t>, 2> joints;
    glm::dvec3 across{1.0, 0.0, 0.0};  ///< unit, from the second to the first
    std::size_t splits_at = 0;         ///< index of the joint that branches, as a hand does into fingers; 0: none
};

/// All pairs of limbs with a common parent, or below two joints in the same place that have one, that mirror each other
/// and have at least three joints. \param chosen  by joint: only these are considered
std::vector<MirroredChains> find_mirrored_chains(const Scene& scene, const RestFrames& rest,
                                                 const std::vector<bool>& chosen);

/// The lowest joint that is an ancestor of all of these; kNone if there is none, or `joints` is empty.
std::uint32_t common_ancestor(const Scene& scene, const RestFrames& rest, const std::vector<std::uint32_t>& joints);

}  // namespace bendy::converter
