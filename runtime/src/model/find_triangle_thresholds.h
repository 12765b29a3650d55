#pragma once

#include <bendy/format/lod.h>

#include <cstdint>
#include <span>
#include <vector>

namespace bendy {

/// Returns for each triangle of `indices` the number of vertices at which two of its corners merge: the triangle exists
/// while more vertices than that are alive. A triangle with two equal corners from the start disappears first, at
/// vertices - 1; one that never disappears has 0. O(n log n) in triangles and vertices, whatever the targets are.
std::vector<std::uint32_t> find_triangle_thresholds(const MeshCollapseView& collapse,
                                                    std::span<const std::uint32_t> indices);

}  // namespace bendy
