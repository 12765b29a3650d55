#pragma once

#include "collapse/find_shapes.h"
#include "collapse/surface.h"

#include <span>
#include <vector>

namespace bendy::converter {

/// Locks points on the borders of two meshes that lie at one place at rest: each mesh has a sequence of its own, and a
/// gap would open between them.
void lock_shared_borders(std::span<const std::vector<Shape>> shapes, std::span<Surface> surfaces);

}  // namespace bendy::converter
