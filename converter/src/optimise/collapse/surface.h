#pragma once

#include "optimise/collapse/find_shapes.h"

#include <bendy/converter/scene.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace bendy::converter {

/// A mesh's triangles as a surface to collapse. Vertices that lie at one place in every shape form one *point*, so that
/// a seam, where they differ in normals or coordinates, is not a border. Work around a point costs time proportional to
/// its neighbourhood.
struct Surface {
    struct Triangle {
        std::array<std::uint32_t, 3> vertices;  ///< of the mesh, one for each point
        std::array<std::uint32_t, 3> points;
        std::uint32_t material = kNone;
        bool is_alive = true;
    };
    std::vector<Triangle> triangles;          ///< those with three distinct points
    std::vector<std::uint32_t> point_of;      ///< per vertex
    std::vector<std::uint32_t> first_vertex;  ///< per point, index into `vertices`; one more than points
    std::vector<std::uint32_t> vertices;      ///< grouped by point
    std::vector<std::uint32_t> alike;         ///< per vertex: the first at its point that is identical to it
    std::vector<bool> is_used;                ///< per vertex: some primitive uses it
    std::vector<bool> is_locked;              ///< per point: must not move
    std::vector<std::uint32_t> first_corner;  ///< per point: list of its corners, 3 * triangle + 0 to 2; kNone: end
    std::vector<std::uint32_t> next_corner;   ///< per corner

    [[nodiscard]] std::uint32_t points() const { return static_cast<std::uint32_t>(is_locked.size()); }
    [[nodiscard]] std::span<const std::uint32_t> vertices_of(std::uint32_t point) const {
        return std::span(vertices).subspan(first_vertex[point], first_vertex[point + 1] - first_vertex[point]);
    }
    /// A vertex that gives the position of a point.
    [[nodiscard]] std::uint32_t vertex_of(std::uint32_t point) const { return vertices[first_vertex[point]]; }
    /// Stores the corners of the live triangles at a point in `corners`; unlinks those of dead triangles.
    void find_corners(std::uint32_t point, std::vector<std::uint32_t>& corners);
};

/// The surface of a mesh. Points that lines or point primitives use, or that have no valid triangle, are locked.
Surface make_surface(const Mesh& mesh, std::span<const Shape> shapes);

/// Marks points on the border: on an edge with only one triangle.
std::vector<bool> find_borders(const Surface& surface);

/// Locks points on the borders of two meshes that coincide at rest: each mesh has its own sequence, and a gap would
/// open between them.
void lock_shared_borders(std::span<const std::vector<Shape>> shapes, std::span<Surface> surfaces);

}  // namespace bendy::converter
