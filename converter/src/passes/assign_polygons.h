#pragma once

#include <bendy/converter/scene.h>

#include <cstdint>
#include <vector>

namespace bendy::converter {

/// A run of the ordered index list with one joint, material and topology.
struct PolygonRange {
    std::uint32_t joint = 0;
    std::uint32_t material = kNone;
    Topology topology = Topology::triangles;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
};

struct AssignedPolygons {
    std::vector<std::uint32_t> indices;  ///< by material first, then topology, then joint; else the source's order
    std::vector<PolygonRange> ranges;    ///< in the order of `indices`, which they cover
};

/// Gives every polygon of a mesh to the joint that has most weight in it (the paper's POLY), ties to the smaller joint
/// number, and orders the index list so that a material is one range. A rigid mesh's polygons go to its joint.
AssignedPolygons assign_polygons(const Mesh& mesh);

}  // namespace bendy::converter
