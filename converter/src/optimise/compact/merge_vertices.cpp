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

/// Orders triangles so that neighbours are adjacent.
class TriangleSorter {
public:
    /// \param vertices  of the mesh
    explicit TriangleSorter(std::size_t vertices) : number_of_(vertices, kUnused) {}

    void sort(std::span<std::uint32_t> indices) {
        // meshoptimizer's work grows with the largest number, so the vertices are numbered by first use.
        for (std::uint32_t& index : indices) {
            std::uint32_t& number = number_of_[index];
            if (number == kUnused) {
                number = static_cast<std::uint32_t>(vertex_of_.size());
                vertex_of_.push_back(index);
                corners_.push_back(0);
            }
            index = number;
            ++corners_[number];
        }
        // At each step it also looks at all triangles around the last vertices. Those at a crowded vertex keep their
        // order, behind the others.
        const auto is_crowded = [&](std::uint32_t number) { return corners_[number] > kMostCorners; };
        for (std::size_t at = 0; at < indices.size(); at += 3) {
            const auto triangle = indices.subspan(at, 3);
            auto& kind = std::any_of(triangle.begin(), triangle.end(), is_crowded) ? crowded_ : sparse_;
            kind.insert(kind.end(), triangle.begin(), triangle.end());
        }
        meshopt_optimizeVertexCacheStrip(indices.data(), sparse_.data(), sparse_.size(), vertex_of_.size());
        std::copy(crowded_.begin(), crowded_.end(), indices.begin() + static_cast<std::ptrdiff_t>(sparse_.size()));
        for (std::uint32_t& index : indices) index = vertex_of_[index];
        for (const std::uint32_t vertex : vertex_of_) number_of_[vertex] = kUnused;
        for (auto* list : {&vertex_of_, &corners_, &sparse_, &crowded_}) list->clear();
    }

private:
    static constexpr std::uint32_t kMostCorners = 512;  // at a vertex: models have less than a hundred

    std::vector<std::uint32_t> number_of_;            // by vertex
    std::vector<std::uint32_t> vertex_of_, corners_;  // by number
    std::vector<std::uint32_t> sparse_, crowded_;     // triangles
};

}  // namespace

void order_for_codecs(Mesh& mesh, CompactMesh& compact, std::span<const std::uint32_t> levels) {
    const std::size_t vertices = mesh.positions.size();
    AssignedPolygons assigned = assign_polygons(mesh);
    TriangleSorter sorter(vertices);
    for (const AssignedSubmesh& range : assigned.ranges) {
        if (range.topology == Topology::triangles)
            sorter.sort(std::span(assigned.indices).subspan(range.first, range.count));
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
