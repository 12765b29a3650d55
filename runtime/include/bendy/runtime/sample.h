#pragma once

#include <bendy/format/public.h>
#include <bendy/format/result.h>
#include <bendy/runtime/call_error.h>
#include <bendy/runtime/pose.h>

#include <span>

namespace BENDY_PUBLIC bendy {

/// Sets the pose to the clip at `seconds` on the clip's own time line (Clip::start to Clip::end): what a track
/// animates gets its value there, the rest is at rest. Times outside a track's keys are held at its first or last key;
/// the caller wraps time for clips that loop. Null, or NaN seconds: an error, and the rest pose.
[[nodiscard]] Result<void, CallError> sample(Pose& pose, const Clip* clip, float seconds);

/// One track at a time, as glTF 2.0 defines it (3.11 and appendix C): step, linear (slerp for rotations, the short way
/// round), cubic (Hermite, tangents times the key distance; rotations normalised). `value` takes the track's
/// components.
void sample_track(const TrackView& track, const Clip& clip, float seconds, std::span<float> value);

/// Two frames of a mesh, numbered as MeshView::frames() has them, and what the second one weighs.
struct FrameMix {
    std::uint32_t left = 0, right = 0;
    float fraction = 0.0f;  ///< [0, 1)
};

/// The frames between which fixed frames are at `seconds`, held to their first and last; closed ones go on from the
/// last frame to the first, and are there again at the end.
[[nodiscard]] FrameMix mix_frames(const PlayView& play, const Clip& clip, float seconds);

}  // namespace bendy
