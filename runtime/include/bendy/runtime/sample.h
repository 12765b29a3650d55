#pragma once

#include <bendy/format/public.h>
#include <bendy/runtime/pose.h>

#include <span>

namespace BENDY_PUBLIC bendy {

/// Sets the pose to the cycle at `seconds` on the cycle's own time line (Cycle::start to Cycle::end): what a track
/// animates gets its value there, the rest is at rest. Times outside a track's keys are held at its first or last key;
/// the caller wraps time for cycles that loop. Null, or NaN seconds: the rest pose, and false.
bool sample(const Cycle* cycle, float seconds, Pose& pose);

/// One track at a time, as glTF 2.0 defines it (3.11 and appendix C): step, linear (slerp for rotations, the short way
/// round), cubic (Hermite, tangents times the key distance; rotations normalised). `value` takes the track's
/// components.
void sample_track(const TrackView& track, const Cycle& cycle, float seconds, std::span<float> value);

}  // namespace bendy
