#pragma once

#include <bendy/format/packed_clip.h>
#include <bendy/runtime/model.h>

#include <cstdint>
#include <span>
#include <vector>

namespace bendy::motion {

/// A joint of the target that pops, and its largest turn in kPopSeconds.
struct JointPop {
    std::uint32_t joint = kNone;
    float seconds = 0.0f;    ///< at its end
    double turn = 0.0;       ///< radians
    double of_source = 0.0;  ///< the largest turn of any joint of the source
};

/// Returns a track to sample, as long as `track` lives.
TrackView view_of(const UnpackedTrack& track);

/// Finds the joints that pop: see kPopTurn.
/// \param clip    of the source
/// \param tracks  of the target
/// \param times   at which the source is looked at
std::vector<JointPop> find_pops(const Model& source, const Clip& clip, std::span<const UnpackedTrack> tracks,
                                std::span<const float> times);

}  // namespace bendy::motion
