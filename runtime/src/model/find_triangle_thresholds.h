#pragma once

#include <bendy/format/lod.h>

#include <cstdint>
#include <span>
#include <vector>

namespace bendy {

/// For each three of `indices` the number of vertices at which two of its corners have become one: the triangle is
/// there while more vertices than that are alive. What has two equal corners from the start dies first, at vertices -
/// 1; what never dies has 0. O(n log n) in triangles and vertices, whatever the targets are.
std::vector<std::uint32_t> find_triangle_thresholds(const MeshCollapseView& collapse,
                                                    std::span<const std::uint32_t> indices);

}  // namespace bendy
