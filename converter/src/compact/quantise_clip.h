#pragma once

#include "compact/grid.h"
#include "space.h"

#include <bendy/converter/scene.h>
#include <bendy/format/packed_clip.h>

#include <memory>
#include <vector>

namespace bendy::converter {

/// What the quantiser may do.
struct QuantiseOptions {
    double max_error = 0.0;  ///< metres in model space, at the probes, at the frames
    /// A joint makes up for the errors of those above it: coarser steps, less even numbers.
    bool corrects = true;
};

/// A clip at the frames of a grid, read once for all attempts to quantise it.
class ClipFrames;

/// Refers to the scene, the clip and the grid's tracks, which must outlive the result.
std::shared_ptr<const ClipFrames> read_frames(const Scene& scene, const Clip& clip, const GridTracks& tracks);

/// Chooses steps for the tracks of the grid, as coarse as the error allows, and gives the quantised samples. Takes time
/// in proportion to frames * joints, times a constant that falls for large clips.
///
/// Steps are found on a part of the frames of long clips: whoever calls this measures the result.
/// \param probes  per joint, see find_probes
PackedSamples quantise(const ClipFrames& frames, const std::vector<std::vector<glm::dvec3>>& probes,
                       const QuantiseOptions& options);

}  // namespace bendy::converter
