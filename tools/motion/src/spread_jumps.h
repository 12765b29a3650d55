#pragma once

#include <bendy/runtime/model.h>
#include <bendy/runtime/transform.h>

#include <cstdint>
#include <span>
#include <vector>

namespace bendy::motion {

/// Turns in a clip that are too quick become slower: they begin before the jump and end after it. A joint stays inside
/// the constraints that it is inside, and as far beyond the others as it is.
/// \param frames   by frame, the joints' transforms
/// \param allowed  by frame, radians by which a joint may turn since the frame before
/// \param joints   those that may be changed
/// \param repeats  the last frame shows the first
/// \return         by frame, whether a joint was changed
std::vector<bool> spread_jumps(const Model& model, std::span<std::vector<JointTransform>> frames,
                               std::span<const double> allowed, std::span<const std::uint32_t> joints, bool repeats);

}  // namespace bendy::motion
