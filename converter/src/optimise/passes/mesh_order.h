#pragma once

#include <bendy/converter/scene.h>

#include <cstdint>
#include <span>
#include <vector>

namespace bendy::converter {

/// A range of the ordered index list with one joint, material and topology.
struct AssignedSubmesh {
    std::uint32_t joint = 0;
    std::uint32_t material = kNone;
    Topology topology = Topology::triangles;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
};

struct AssignedPolygons {
    std::vector<std::uint32_t> indices;   ///< sorted by material, topology, joint; otherwise in the source's order
    std::vector<AssignedSubmesh> ranges;  ///< in the order of `indices`, covering all of it
};

/// Assigns every polygon of a mesh to the joint with the most weight in it (the paper's POLY), on a tie to the smaller
/// joint number, and orders the index list so that each material is one range. A rigid mesh's polygons go to its joint.
AssignedPolygons assign_polygons(const Mesh& mesh);

/// Reorders a mesh's vertices, with all streams, targets and indices; the collapse sequence is ignored.
/// \param order  the old number of each new vertex; each at most once, and only vertices that no primitive uses may be
///               omitted
/// \return the new number of each old vertex, kNone if it was omitted
std::vector<std::uint32_t> permute_vertices(Mesh& mesh, std::span<const std::uint32_t> order);

/// Keeps one level of detail: the first `vertices[m]` vertices of each mesh; the others collapse onto them. Triangles
/// without area and the collapse sequences are removed. Throws Failure if there are not as many numbers as meshes, or a
/// number is below a mesh's base or, for a mesh without a sequence, not its vertex count.
void keep_level(Scene& scene, std::span<const std::uint32_t> vertices);

}  // namespace bendy::converter
