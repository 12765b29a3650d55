#pragma once

#include <bendy/runtime.h>

#include <vector>

namespace bendy::viewer {

/// The surface of each material as it is drawn: with the strength of its light that KHR_materials_emissive_strength
/// gives. One more at the end, glTF's default one, for what has no material.
std::vector<SurfaceRecord> shown_surfaces(const Model& model);

}  // namespace bendy::viewer
