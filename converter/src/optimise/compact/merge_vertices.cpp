#include "optimise/compact/compact_geometry.h"
#include "optimise/passes/bone_order.h"
#include "optimise/passes/equal_vertices.h"
#include "optimise/passes/level_order.h"
#include "optimise/passes/mesh_order.h"
#include "optimise/passes/mesh_streams.h"

#include <bendy/format/codec.h>

#include <meshoptimizer.h>

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace bendy::converter {
namespace {

constexpr std::uint32_t kUnused = ~0u;

/// Calls visit(vector, entries per vertex) for every per-vertex vector of a mesh and its integers.
template <class Visit>
void for_each_stream(Mesh& mesh, CompactMesh& compact, const Visit& visit) {
    for_each_stream(mesh, visit);
    const auto stored = [&](std::optional<StoredStream>& stream) {
        if (stream) visit(stream->bytes, stream->row());
    };
    for (auto* stream : {&compact.positions, &compact.normals, &compact.tangents, &compact.weights}) stored(*stream);
    for (auto& stream : compact.texture_coords) stored(stream);
    for (auto& stream : compact.colours) stored(stream);
    for (CompactTarget& target : compact.targets) {
        for (auto* stream : {&target.positions, &target.normals, &target.tangents}) stored(*stream);
    }
}

/// Moves vertex v to place_of[v]; of several with the same place the first is kept.
void move_vertices(Mesh& mesh, CompactMesh& compact, std::span<const std::uint32_t> place_of, std::size_t count) {
    for_each_stream(mesh, compact, [&](auto& values, std::size_t width) {
        if (values.empty()) return;
        std::remove_reference_t<decltype(values)> moved(count * width);
        for (std::size_t vertex = place_of.size(); vertex-- > 0;) {
            std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(vertex * width), width,
                        moved.begin() + static_cast<std::ptrdiff_t>(place_of[vertex] * width));
        }
        values = std::move(moved);
    });
    for (std::uint32_t& vertex : compact.vertex_of) vertex = place_of[vertex];
    for (Submesh& submesh : mesh.submeshes) {
        for (std::uint32_t& index : submesh.indices) index = place_of[index];
    }
}

}  // namespace

void merge_vertices(Mesh& mesh, CompactMesh& compact) {
    const std::size_t vertices = mesh.positions.size();
    std::vector<VertexRows> rows;
    for_each_stream(mesh, compact, [&](const auto& values, std::size_t entries) { add_rows(rows, values, entries); });
    const std::vector<std::uint32_t> first_of = first_equal_vertices(vertices, rows);
    std::vector<std::uint32_t> place_of(vertices);
    std::uint32_t count = 0;
    for (std::size_t vertex = 0; vertex < vertices; ++vertex)
        place_of[vertex] = first_of[vertex] == vertex ? count++ : place_of[first_of[vertex]];
    if (count != vertices) move_vertices(mesh, compact, place_of, count);
}

namespace {

/// The places in order of first use, or sorted by bones if that saves enough; in either case inside the levels.
std::vector<std::uint32_t> sorted_if_worth(const Mesh& mesh, std::span<const std::uint32_t> used,
                                           std::span<const std::uint32_t> levels) {
    // Bones of eight neighbours: less is not worth 0.3 bytes a vertex, by which other orders are encoded worse.
    constexpr double kLeastSaved = 0.5;
    const auto in_levels = [&](std::vector<std::uint32_t> places) {
        return mesh.collapse.empty() ? places : places_in_levels(mesh, places, levels);
    };
    std::vector<std::uint32_t> places = in_levels({used.begin(), used.end()});
    if (mesh.influences == 0) return places;
    const BoneOrder bones(mesh);
    std::vector<std::uint32_t> sorted = in_levels(bones.sorted(used));
    return bones.bones_of_eight(places) - bones.bones_of_eight(sorted) < kLeastSaved ? places : sorted;
}

}  // namespace

void order_for_codecs(Mesh& mesh, CompactMesh& compact, std::span<const std::uint32_t> levels) {
    const std::size_t vertices = mesh.positions.size();
    AssignedPolygons assigned = assign_polygons(mesh);
    for (const AssignedSubmesh& range : assigned.ranges) {
        if (range.topology != Topology::triangles) continue;
        const auto part = std::span(assigned.indices).subspan(range.first, range.count);
        const std::vector<std::uint32_t> before(part.begin(), part.end());
        meshopt_optimizeVertexCacheStrip(part.data(), before.data(), before.size(), vertices);
    }
    // Vertices in order of first use; unused ones are kept, at the end.
    std::vector<std::uint32_t> place_of(vertices, kUnused);
    std::uint32_t next = 0;
    for (const std::uint32_t vertex : assigned.indices) {
        if (place_of[vertex] == kUnused) place_of[vertex] = next++;
    }
    for (std::uint32_t& place : place_of) {
        if (place == kUnused) place = next++;
    }
    place_of = sorted_if_worth(mesh, place_of, levels);
    if (!mesh.collapse.empty()) move_collapse(mesh, place_of);
    mesh.submeshes.clear();
    move_vertices(mesh, compact, place_of, vertices);
    for (std::uint32_t& index : assigned.indices) index = place_of[index];
    const bool all_triangles = std::all_of(assigned.ranges.begin(), assigned.ranges.end(),
                                           [](const AssignedSubmesh& r) { return r.topology == Topology::triangles; });
    if (all_triangles) {
        if (auto canonical = canonical_triangles(assigned.indices)) assigned.indices = std::move(*canonical);
    }
    for (const AssignedSubmesh& range : assigned.ranges) {
        const auto indices = std::span(assigned.indices).subspan(range.first, range.count);
        mesh.submeshes.push_back({range.topology, range.material, {indices.begin(), indices.end()}});
    }
}

}  // namespace bendy::converter
