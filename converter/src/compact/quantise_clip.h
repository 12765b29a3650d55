#pragma once

#include "compact/clip_frames.h"
#include "compact/grid.h"

#include <bendy/converter/scene.h>
#include <bendy/format/packed_clip.h>

#include <vector>

namespace bendy::converter {

/// What the quantiser may do.
struct QuantiseOptions {
    double max_error = 0.0;  ///< metres in model space, at the probes, at the frames
    /// A joint makes up for the errors of those above it: coarser steps, less even numbers.
    bool corrects = true;
};

/// Chooses steps for the tracks `packed` of the clip, as coarse as the error allows, and gives the quantised samples.
/// Takes time in proportion to frames * joints, times a constant that falls for large clips.
///
/// Steps are found on a part of the frames of long clips: whoever calls this measures the result.
/// \param frames  of the clip, at the grid's times
/// \param probes  per joint, see find_probes
PackedSamples quantise(const ClipFrames& frames, const Clip& clip, const GridTracks& packed,
                       const std::vector<std::vector<glm::dvec3>>& probes, const QuantiseOptions& options);

}  // namespace bendy::converter
