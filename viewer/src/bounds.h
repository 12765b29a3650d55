#pragma once

#include "camera.h"

#include <bendy/runtime.h>

namespace bendy::viewer {

/// A sphere round all that is drawn of a model over a cycle, at some of its times; null: the rest pose. Without
/// vertices, round the joints.
Sphere bounding_sphere(const Model& model, const Cycle* cycle);

}  // namespace bendy::viewer
