#pragma once

#include "camera.h"

#include <bendy/runtime.h>

namespace bendy::viewer {

/// A box round all that is drawn of a model over a cycle, at some of its times; null: the rest pose. Without
/// vertices, round the joints.
Box bounding_box(const Model& model, const Cycle* cycle);

}  // namespace bendy::viewer
