#pragma once

#include <bendy/converter/scene.h>

#include <cstdint>
#include <span>
#include <vector>

namespace bendy::converter {

/// The vertex counts of mesh `number` at its levels, ascending, from the base to all. Levels that would split vertices
/// that collapse together are left out.
std::vector<std::uint32_t> levels_of(const Scene& scene, std::uint32_t number);

/// The order of the vertices of a mesh with a collapse sequence, by `rank` where that changes the geometry of no level:
/// each vertex stays between the same two levels, of which the first holds the vertices that never collapse, and
/// follows the vertex that it collapses onto. Collapses that change or look at the same triangle keep their order, so
/// each collapse still finds the triangles around it that it was measured with, also at a count between two levels.
/// Vertices that collapse together stay together. Levels that collapse fewer than 64 vertices keep their order.
/// \param rank    by vertex: where it would be best, smallest first; each number once
/// \param levels  as levels_of returns them
/// \return the new number of each vertex
std::vector<std::uint32_t> places_in_levels(const Mesh& mesh, std::span<const std::uint32_t> rank,
                                            std::span<const std::uint32_t> levels);

/// Renumbers Mesh::collapse and joined; the mesh's other streams are unchanged.
/// \param place_of  the new number of each vertex
void move_collapse(Mesh& mesh, std::span<const std::uint32_t> place_of);

}  // namespace bendy::converter
