#pragma once

#include "optimise/compact/clip_frames.h"
#include "optimise/compact/grid.h"

#include <bendy/converter/scene.h>
#include <bendy/format/packed_clip.h>

#include <vector>

namespace bendy::converter {

/// Limits and options of the quantiser.
struct QuantiseOptions {
    double max_error = 0.0;  ///< metres in model space, at the probes, at the frames
    /// Each joint compensates for the errors of its ancestors: allows coarser steps, but makes numbers less regular.
    bool corrects = true;
};

/// Chooses steps for the tracks `packed` of the clip, as coarse as the error allows, and returns the quantised samples.
/// Time is proportional to frames * joints, with a factor that falls for large clips.
///
/// For long clips, steps are chosen on a part of the frames: the caller must measure the result.
/// \param frames  of the clip, at the grid's times
/// \param probes  per joint, see find_probes
PackedSamples quantise(const ClipFrames& frames, const Clip& clip, const GridTracks& packed,
                       const std::vector<std::vector<glm::dvec3>>& probes, const QuantiseOptions& options);

}  // namespace bendy::converter
