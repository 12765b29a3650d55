#pragma once

#include <bendy/runtime/model.h>

#include <cstddef>
#include <vector>

namespace bendy::motion {

/// Returns the times at which a clip is sampled, seconds, strictly ascending from its start to its end: those of its
/// keys, just before a key where a value jumps, and others between them, so that neighbours are at most 1/60 s apart.
/// In clips that are very long for what is in them, neighbours are farther apart.
/// \param most  number of times, 2 or more; where there were more, they are spread evenly
std::vector<float> sample_times(const Clip& clip, std::size_t most);

}  // namespace bendy::motion
