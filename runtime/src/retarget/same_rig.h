#pragma once

#include <bendy/runtime/model.h>
#include <bendy/runtime/transform.h>

#include <vector>

namespace bendy {

/// Returns the joints of a model, relative to their parents, in its standing pose; at rest if it has none.
std::vector<JointTransform> standing_locals(const Model& model);

/// Returns the source's joints as standing_locals of the target has them, if both are of the same rig: roles, names and
/// lengths are equal, so that rotations mean the same, however the two rest. Otherwise nothing, nor if all joints are
/// turned alike: then the source says itself how high it stands. Files of clips often rest in a frame of their clip.
std::vector<JointTransform> locals_of_same_rig(const Model& source, const Model& target);

}  // namespace bendy
