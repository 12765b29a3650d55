#pragma once

#include "camera.h"

#include <bendy/runtime.h>

#include <glm/vec3.hpp>

#include <functional>
#include <span>
#include <vector>

namespace bendy::viewer {

/// True if something of the model's surface is drawn: it has triangles, lines or points. Else the skeleton stands for
/// it.
bool has_surface(const Model& model);

/// Joints that only say where IK chains are to go, targets and poles: no part of the skeleton. One a joint.
std::vector<bool> find_controls(const Model& model);

/// A box round all that is drawn of a model over a clip, at some of its times; null: the rest pose. Without a surface,
/// round the joints, controls apart.
/// \param adjust  changes every pose after the clip; may be empty
/// \param others  points that the box is to hold
Box bounding_box(const Model& model, const Clip* clip, const std::function<void(Pose&)>& adjust = {},
                 std::span<const glm::vec3> others = {});

}  // namespace bendy::viewer
