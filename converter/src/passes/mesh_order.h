#pragma once

#include <bendy/converter/scene.h>

#include <cstdint>
#include <span>
#include <vector>

namespace bendy::converter {

/// A run of the ordered index list with one joint, material and topology.
struct AssignedSubmesh {
    std::uint32_t joint = 0;
    std::uint32_t material = kNone;
    Topology topology = Topology::triangles;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
};

struct AssignedPolygons {
    std::vector<std::uint32_t> indices;   ///< by material first, then topology, then joint; else the source's order
    std::vector<AssignedSubmesh> ranges;  ///< in the order of `indices`, which they cover
};

/// Gives every polygon of a mesh to the joint that has most weight in it (the paper's POLY), ties to the smaller joint
/// number, and orders the index list so that a material is one range. A rigid mesh's polygons go to its joint.
AssignedPolygons assign_polygons(const Mesh& mesh);

/// Puts a mesh's vertices in another order, with all streams, targets and indices; its collapse sequence is not looked
/// at. \param order the old number of each new vertex; every one once, but for vertices that nothing is drawn with:
/// they may be left out \return the new number of each old vertex, kNone if it was left out
std::vector<std::uint32_t> permute_vertices(Mesh& mesh, std::span<const std::uint32_t> order);

/// Puts vertices that follow the same bones beside one another, so that skinning eight neighbours takes few matrices:
/// by the sorted list of their bones, those that follow the same ones in the order in which they were. A rigid mesh,
/// and one whose vertices are in the order of a collapse sequence, stay as they are.
void sort_by_bones(Mesh& mesh);

/// Keeps one level of detail: the first `vertices[m]` of each mesh's vertices, the others collapsed onto those;
/// triangles that lose their area go, and so do the collapse sequences. Throws Failure where there are not as many
/// numbers as meshes, or a number is below a mesh's base or, without a sequence, not all of it.
void keep_level(Scene& scene, std::span<const std::uint32_t> vertices);

}  // namespace bendy::converter
