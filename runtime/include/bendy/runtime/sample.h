#pragma once

#include <bendy/format/public.h>
#include <bendy/format/result.h>
#include <bendy/runtime/call_error.h>
#include <bendy/runtime/pose.h>

#include <span>

namespace BENDY_PUBLIC bendy {

/// Sets the pose to the clip at `seconds` on the clip's time line (Clip::start to Clip::end). Whatever the clip does
/// not animate is set to rest. Times outside a track's keys are clamped to its first or last key; the caller wraps time
/// for clips that loop. Returns an error, and sets the rest pose, for NaN seconds and for a clip that is null or does
/// not belong to the pose's model; Binding samples clips of other models.
[[nodiscard]] Result<void, CallError> sample(Pose& pose, const Clip* clip, float seconds);

/// Samples a single track as defined by glTF 2.0 (3.11 and appendix C): step, linear (slerp along the shorter arc for
/// rotations), cubic (Hermite, tangents multiplied by the key distance; rotations normalised).
/// \param clip   the track's own
/// \param value  receives TrackView::components numbers; nothing is written if it is smaller
void sample_track(const TrackView& track, const Clip& clip, float seconds, std::span<float> value);

/// Two frames of a mesh, numbered as in MeshView::frames(), and the weight of the second one.
struct FrameMix {
    std::uint32_t left = 0, right = 0;
    float fraction = 0.0f;  ///< [0, 1)
};

/// Returns the frames around `seconds`, clamped to the first and last frame; closed ones continue from the last frame
/// to the first, and are at the first frame again at the end.
[[nodiscard]] FrameMix mix_frames(const PlayRecord& play, const Clip& clip, float seconds);

/// Sets the pose in which the model's body stands (Model::standing_pose): joints that it names are turned as it says,
/// and all else is at rest. Returns false, with the rest pose, if the model has none.
bool stand(Pose& pose);

}  // namespace bendy
