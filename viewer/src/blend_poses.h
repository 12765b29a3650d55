#pragma once

#include <bendy/runtime/pose.h>

namespace bendy::viewer {

/// Mixes a pose of the same model into another: translations, scales and target weights in a straight line, rotations
/// the short way round. `share` 0: `pose` stays; 1: it becomes `other`.
void blend_poses(const Pose& other, float share, Pose& pose);

}  // namespace bendy::viewer
