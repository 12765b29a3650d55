#pragma once

#include "evaluate.h"

#include <cstddef>
#include <limits>
#include <vector>

namespace bendy::converter {

/// Poses to estimate by: the rest pose, then every cycle at times spread evenly from its first key to its last.
/// \param most           of all cycles together; large skeletons get fewer, so that they take some 130 MB at most
/// \param most_of_cycle  of one cycle
std::vector<EvaluatedPose> sample_poses(const Scene& scene, std::size_t most,
                                        std::size_t most_of_cycle = std::numeric_limits<std::size_t>::max());

}  // namespace bendy::converter
