#pragma once

#include "stored_numbers.h"

#include <bendy/converter/scene.h>

#include <functional>
#include <optional>
#include <vector>

namespace bendy::converter {

struct CompactTarget {
    std::optional<StoredStream> positions, normals, tangents;
};

/// The streams of a mesh that are stored as integers; an absent one stays as the mesh has it.
struct CompactMesh {
    std::optional<StoredStream> positions, normals, tangents, weights;
    std::vector<std::optional<StoredStream>> texture_coords, colours;  ///< as many as the mesh has
    std::vector<CompactTarget> targets;                                ///< as many
    std::optional<glm::mat4> bind_base;    ///< the inverse bind matrices follow from it and the rest pose
    std::vector<std::uint32_t> vertex_of;  ///< which vertex the source's vertex n has become
};

struct CompactGeometry {
    std::vector<CompactMesh> meshes;  ///< one per mesh of the scene
    double error = 0.0;               ///< metres: by how much points of the skin may move, at most
};

/// Quantises all meshes of a scene, merges vertices that have become equal, and orders triangles and vertices for the
/// codecs. The scene's numbers become what the integers decode to. A mesh's vertices keep their number and order where
/// is_order_fixed.
/// \param most_error  metres in model space: what positions, weights and morph targets together may move a point
///                    of the skin, at rest and in the poses of the scene's clips; above 0
/// \param progress    called with 0 to 1; may be empty
CompactGeometry compact_geometry(Scene& scene, double most_error, const std::function<void(double)>& progress);

/// True if something else has settled the order of a mesh's vertices: its sequence of collapses.
bool is_order_fixed(const Mesh& mesh);

/// Merges vertices that are alike in every stream, bone and displacement, to the bit.
void merge_vertices(Mesh& mesh, CompactMesh& compact);

/// Orders the triangles of each range of assign_polygons so that neighbours follow one another, and the vertices as
/// they are used first; the mesh's parts become these ranges. Lines and points keep their order.
void order_for_codecs(Mesh& mesh, CompactMesh& compact);

}  // namespace bendy::converter
