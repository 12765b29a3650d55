#pragma once

#include "compact/grid.h"

#include <bendy/converter/scene.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace bendy::converter {

/// A grid of the same span with fewer frames.
struct ThinGrid {
    Grid grid;
    /// Metres: what lines between its frames cost the worst joint alone, at its own probes and at the old frames. What
    /// the joints above cost comes on top.
    double error = 0.0;
};

/// About one frame of `fewer`, evenly spaced: frames need not lie on keys. Nothing if the old grid is uneven, few
/// frames would be left, or the error is more than `most` metres. \param probes  per joint, see find_probes
std::optional<ThinGrid> thin_grid(const Scene& scene, const Cycle& cycle, const GridTracks& tracks, std::uint32_t fewer,
                                  const std::vector<std::vector<glm::dvec3>>& probes, double most);

}  // namespace bendy::converter
