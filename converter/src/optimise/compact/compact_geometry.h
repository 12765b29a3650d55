#pragma once

#include "scene/stored_numbers.h"

#include <bendy/converter/scene.h>

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace bendy::converter {

struct CompactTarget {
    std::optional<StoredStream> positions, normals, tangents;
};

/// The streams of a mesh that are stored as integers; an absent one keeps the mesh's numbers.
struct CompactMesh {
    std::optional<StoredStream> positions, normals, tangents, weights;
    std::vector<std::optional<StoredStream>> texture_coords, colours;  ///< as many as the mesh has
    std::vector<CompactTarget> targets;                                ///< as many
    std::optional<glm::mat4> bind_base;    ///< set if the inverse bind matrices follow from it and the rest pose
    std::vector<std::uint32_t> vertex_of;  ///< the new number of the source's vertex n
    double stretch = 1.0;  ///< the most by which a displacement in the mesh's space is lengthened in model space
};

struct CompactGeometry {
    std::vector<CompactMesh> meshes;  ///< one per mesh of the scene
    double error = 0.0;               ///< metres: the most that points of the skin may move
};

/// Quantises all meshes of a scene, merges vertices that become equal, and orders triangles and vertices for the
/// codecs. The scene's numbers are replaced by the decoded integers. Vertices of a mesh with a collapse sequence are
/// not merged, and stay between the same two levels.
/// \param most_error  metres in model space: the most that positions, weights and morph targets together may move a
///                    point of the skin, at rest and in the poses of the scene's clips; above 0
/// \param progress    called with 0 to 1; may be empty
CompactGeometry compact_geometry(Scene& scene, double most_error, const std::function<void(double)>& progress);

/// Merges vertices that are bit-identical in every stream, bone and displacement.
void merge_vertices(Mesh& mesh, CompactMesh& compact);

/// Orders the triangles of each range of assign_polygons so that neighbours are adjacent, and the vertices by first
/// use, or by their bones where that saves much of the work of skinning; the mesh's parts become these ranges. Lines
/// and points keep their order.
/// \param levels  as levels_of returns them; used for a mesh with a collapse sequence, see places_in_levels
void order_for_codecs(Mesh& mesh, CompactMesh& compact, std::span<const std::uint32_t> levels);

}  // namespace bendy::converter
