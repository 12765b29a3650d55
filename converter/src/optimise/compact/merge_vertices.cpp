#include "optimise/compact/compact_geometry.h"
#include "optimise/passes/mesh_order.h"

#include <bendy/format/codec.h>

#include <meshoptimizer.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <numeric>
#include <queue>
#include <span>
#include <utility>
#include <vector>

namespace bendy::converter {
namespace {

constexpr std::uint32_t kUnused = ~0u;

/// Calls visit(vector, entries per vertex) for every per-vertex vector of a mesh and its integers.
template <class Visit>
void for_each_stream(Mesh& mesh, CompactMesh& compact, const Visit& visit) {
    visit(mesh.positions, 1);
    visit(mesh.normals, 1);
    visit(mesh.tangents, 1);
    for (auto* streams : {&mesh.texture_coords, &mesh.colours, &mesh.attributes}) {
        for (Stream& stream : *streams) visit(stream.values, stream.components);
    }
    visit(mesh.bones, mesh.influences);
    visit(mesh.weights, mesh.influences);
    for (MorphTarget& target : mesh.targets) {
        visit(target.positions, 1);
        visit(target.normals, 1);
        visit(target.tangents, 1);
    }
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
    std::vector<std::vector<std::byte>> columns;  // all of a vertex's data, row by row
    std::vector<std::size_t> widths;
    for_each_stream(mesh, compact, [&](const auto& values, std::size_t width) {
        if (values.empty() || width == 0) return;
        const auto bytes = std::as_bytes(std::span(values));
        columns.emplace_back(bytes.begin(), bytes.end());
        widths.push_back(width * sizeof(values[0]));
    });
    std::vector<std::uint32_t> order(vertices);
    std::iota(order.begin(), order.end(), 0u);
    const auto compare = [&](std::uint32_t a, std::uint32_t b) {
        for (std::size_t c = 0; c < columns.size(); ++c) {
            const int sign =
                std::memcmp(columns[c].data() + a * widths[c], columns[c].data() + b * widths[c], widths[c]);
            if (sign != 0) return sign;
        }
        return 0;
    };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const int sign = compare(a, b);
        return sign != 0 ? sign < 0 : a < b;
    });
    std::vector<std::uint32_t> first_of(vertices);  // the first identical vertex
    for (std::size_t k = 0; k < vertices; ++k) {
        const bool is_alike = k != 0 && compare(order[k - 1], order[k]) == 0;
        first_of[order[k]] = is_alike ? first_of[order[k - 1]] : order[k];
    }
    std::vector<std::uint32_t> place_of(vertices);
    std::uint32_t count = 0;
    for (std::size_t vertex = 0; vertex < vertices; ++vertex)
        place_of[vertex] = first_of[vertex] == vertex ? count++ : place_of[first_of[vertex]];
    if (count != vertices) move_vertices(mesh, compact, place_of, count);
}

namespace {

/// The vertex order for a mesh with a collapse sequence: each vertex stays between the same two levels, of which the
/// first holds the vertices that never collapse, and is sorted by first use, after the vertex that it collapses onto.
/// Vertices that collapse together stay together.
/// \param used  by vertex: when it is first used
class PlacesInLevels {
public:
    PlacesInLevels(const Mesh& mesh, std::span<const std::uint32_t> used)
        : mesh_(mesh), used_(used), first_of_(mesh.positions.size()), place_of_(mesh.positions.size()) {
        for (std::uint32_t vertex = 0; vertex < first_of_.size(); ++vertex)
            first_of_[vertex] = mesh.joined[vertex] != 0 ? first_of_[vertex - 1] : vertex;
    }

    /// \param levels  the number of vertices alive at each, ascending, from mesh.base to all
    std::vector<std::uint32_t> find(std::span<const std::uint32_t> levels) {
        std::uint32_t begin = 0;
        for (const std::uint32_t end : levels) {
            order_level(begin, end);
            begin = end;
        }
        return std::move(place_of_);
    }

private:
    void order_level(std::uint32_t begin, std::uint32_t end) {
        struct Group {
            std::uint32_t used = kUnused;
            std::uint32_t waits_for = 0;
            std::vector<std::uint32_t> waiting;
        };
        std::vector<Group> groups(end - begin);  // keyed by the first vertex
        for (std::uint32_t vertex = begin; vertex < end; ++vertex) {
            const std::uint32_t first = first_of_[vertex];
            Group& group = groups[first - begin];
            group.used = std::min(group.used, used_[vertex]);
            const std::uint32_t target = mesh_.collapse[vertex];
            if (target < begin || first_of_[target] == first) continue;
            ++group.waits_for;
            groups[first_of_[target] - begin].waiting.push_back(first);
        }
        using Ready = std::pair<std::uint32_t, std::uint32_t>;  // time of first use, and the first vertex
        std::priority_queue<Ready, std::vector<Ready>, std::greater<>> ready;
        const auto add = [&](std::uint32_t first) { ready.emplace(groups[first - begin].used, first); };
        for (std::uint32_t vertex = begin; vertex < end; ++vertex) {
            if (first_of_[vertex] == vertex && groups[vertex - begin].waits_for == 0) add(vertex);
        }
        std::uint32_t next = begin;
        while (!ready.empty()) {
            const std::uint32_t first = ready.top().second;
            ready.pop();
            for (std::uint32_t vertex = first; vertex < end && first_of_[vertex] == first; ++vertex)
                place_of_[vertex] = next++;
            for (const std::uint32_t other : groups[first - begin].waiting) {
                if (--groups[other - begin].waits_for == 0) add(other);
            }
        }
    }

    const Mesh& mesh_;
    std::span<const std::uint32_t> used_;
    std::vector<std::uint32_t> first_of_;  ///< by vertex: the first vertex of its joint collapse
    std::vector<std::uint32_t> place_of_;
};

void move_collapse(Mesh& mesh, std::span<const std::uint32_t> place_of) {
    std::vector<std::uint32_t> collapse(place_of.size());
    std::vector<std::uint8_t> joined(place_of.size());
    for (std::size_t vertex = 0; vertex < place_of.size(); ++vertex) {
        collapse[place_of[vertex]] = place_of[mesh.collapse[vertex]];
        joined[place_of[vertex]] = mesh.joined[vertex];
    }
    mesh.collapse = std::move(collapse);
    mesh.joined = std::move(joined);
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
    mesh.submeshes.clear();
    if (!mesh.collapse.empty()) {
        place_of = PlacesInLevels(mesh, place_of).find(levels);
        move_collapse(mesh, place_of);
    }
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
