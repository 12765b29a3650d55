#pragma once

#include "compact/affine.h"

#include <bendy/converter/scene.h>
#include <bendy/format/packed_cycle.h>

#include <cstdint>
#include <vector>

namespace bendy::converter {

/// The farthest that a probe is from where the source has it.
struct WorstError {
    double metres = 0.0;  ///< in model space
    std::uint32_t joint = kNone;
    double seconds = 0.0;  ///< on the cycle's time line
};

/// Plays a packed cycle against its source, 240 times a second and at each of the source's key times, the source
/// interpolated as glTF says.
/// \param source       with all tracks
/// \param is_replaced  per track: the packed cycle has it, or leaves the property at rest
/// \param packed       as read from the bytes that are written
/// \param enough       stops at the first error above this
WorstError measure_packed(const Scene& scene, const Cycle& source, const std::vector<bool>& is_replaced,
                          const PackedView& packed, const std::vector<std::vector<glm::dvec3>>& probes, double enough);

}  // namespace bendy::converter
