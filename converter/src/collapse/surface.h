#pragma once

#include "collapse/find_shapes.h"

#include <bendy/converter/scene.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace bendy::converter {

/// A mesh's triangles as a surface that is collapsed. Vertices that lie at one place in every shape are one *point*, so
/// that a seam, where they differ in normals or coordinates, is no border. Work on the neighbourhood of a point costs
/// what the neighbourhood holds.
struct Surface {
    struct Triangle {
        std::array<std::uint32_t, 3> vertices;  ///< of the mesh, one for each point
        std::array<std::uint32_t, 3> points;
        std::uint32_t material = kNone;
        bool is_alive = true;
    };
    std::vector<Triangle> triangles;          ///< those with three different points
    std::vector<std::uint32_t> point_of;      ///< of each vertex
    std::vector<std::uint32_t> first_vertex;  ///< of each point, in `vertices`; one more than points
    std::vector<std::uint32_t> vertices;      ///< by point
    std::vector<std::uint32_t> alike;         ///< per vertex: the first at its point that differs from it in nothing
    std::vector<bool> is_used;                ///< per vertex: anything is drawn of it
    std::vector<bool> is_locked;              ///< per point: stays where it is
    std::vector<std::uint32_t> first_corner;  ///< per point: a list of its corners, 3 * triangle + 0 to 2; kNone: end
    std::vector<std::uint32_t> next_corner;   ///< per corner

    [[nodiscard]] std::uint32_t points() const { return static_cast<std::uint32_t>(is_locked.size()); }
    [[nodiscard]] std::span<const std::uint32_t> vertices_of(std::uint32_t point) const {
        return std::span(vertices).subspan(first_vertex[point], first_vertex[point + 1] - first_vertex[point]);
    }
    /// Where a point lies: any of its vertices says so.
    [[nodiscard]] std::uint32_t vertex_of(std::uint32_t point) const { return vertices[first_vertex[point]]; }
    /// The corners of the living triangles at a point, into `corners`; those of dead ones are unlinked on the way.
    void find_corners(std::uint32_t point, std::vector<std::uint32_t>& corners);
};

/// The surface of a mesh; points that lines or points are drawn of, or that no good triangle has, are locked.
Surface make_surface(const Mesh& mesh, std::span<const Shape> shapes);

/// Points at the border: on an edge with one triangle.
std::vector<bool> find_borders(const Surface& surface);

/// Locks points on the borders of two meshes that lie at one place at rest: each mesh has a sequence of its own, and a
/// gap would open between them.
void lock_shared_borders(std::span<const std::vector<Shape>> shapes, std::span<Surface> surfaces);

}  // namespace bendy::converter
