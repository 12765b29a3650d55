#include "collapse/collapse_vertices.h"

#include "collapse/find_shapes.h"
#include "collapse/sequence.h"
#include "collapse/surface.h"
#include "passes/mesh_order.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace bendy::converter {
namespace {

constexpr std::size_t kMostLevels = 32;
constexpr double kStep = 0.9;  // of the vertices that can go, so many are left at the next level

struct Move {
    float error;
    std::uint32_t mesh;
    bool is_joined;
};

/// Levels at which all meshes have gone as far as one error allows, from full detail to the least, some tens of them,
/// each with about the same share of the vertices of the one before.
std::vector<LodLevel> make_levels(std::span<const Mesh> meshes, std::span<const Sequence> sequences) {
    std::vector<Move> moves;
    for (std::uint32_t mesh = 0; mesh < sequences.size(); ++mesh) {
        for (const VertexMove& move : sequences[mesh].moves) moves.push_back({move.error, mesh, move.is_joined});
    }
    if (moves.empty()) return {};
    std::stable_sort(moves.begin(), moves.end(), [](const Move& a, const Move& b) { return a.error < b.error; });
    LodLevel level;
    for (const Mesh& mesh : meshes) level.alive.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
    std::vector<LodLevel> levels{level};
    double next = kStep * static_cast<double>(moves.size());
    for (std::size_t done = 0; done < moves.size();) {
        level.error = moves[done].error;
        --level.alive[moves[done].mesh];
        const std::size_t left = moves.size() - ++done;
        const bool is_last = left == 0;
        if (!is_last && moves[done].is_joined) continue;
        if (!is_last && (static_cast<double>(left) > next || levels.size() + 1 >= kMostLevels)) continue;
        next = kStep * static_cast<double>(left);
        levels.push_back(level);
    }
    return levels;
}

/// Sorts a mesh's vertices so that those that are left longest come first, with all streams, targets and indices, and
/// fills Mesh::collapse, joined and base. A sequence without moves changes nothing.
void order_vertices(Mesh& mesh, const Sequence& sequence) {
    if (sequence.moves.empty()) return;
    const std::size_t vertices = mesh.positions.size();
    std::vector<bool> moves(vertices);
    for (const VertexMove& move : sequence.moves) moves[move.from] = true;
    std::vector<std::uint32_t> order;
    order.reserve(vertices);
    for (std::uint32_t vertex = 0; vertex < vertices; ++vertex) {
        if (!moves[vertex]) order.push_back(vertex);
    }
    mesh.base = static_cast<std::uint32_t>(order.size());
    // Backwards; of those that go together the first stays the first.
    for (std::size_t end = sequence.moves.size(); end > 0;) {
        std::size_t begin = end - 1;
        while (sequence.moves[begin].is_joined) --begin;
        for (std::size_t move = begin; move < end; ++move) order.push_back(sequence.moves[move].from);
        end = begin;
    }
    const std::vector<std::uint32_t> number = permute_vertices(mesh, order);
    mesh.collapse.resize(vertices);
    mesh.joined.assign(vertices, 0);
    for (std::uint32_t vertex = 0; vertex < mesh.base; ++vertex) mesh.collapse[vertex] = vertex;
    for (const VertexMove& move : sequence.moves) {
        mesh.collapse[number[move.from]] = number[move.to];
        mesh.joined[number[move.from]] = move.is_joined ? 1 : 0;
    }
}

}  // namespace

void collapse_vertices(Scene& scene) {
    const std::vector<std::vector<Shape>> shapes = find_shapes(scene);
    std::vector<Surface> surfaces;
    surfaces.reserve(scene.meshes.size());
    for (std::size_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
        surfaces.push_back(make_surface(scene.meshes[mesh], shapes[mesh]));
        // One for all that are alike: else triangles between doubles would stay when they have no area any more.
        for (Submesh& submesh : scene.meshes[mesh].submeshes) {
            for (std::uint32_t& index : submesh.indices) index = surfaces.back().alike[index];
        }
    }
    lock_shared_borders(shapes, surfaces);
    std::vector<Sequence> sequences;
    sequences.reserve(surfaces.size());
    for (std::size_t mesh = 0; mesh < surfaces.size(); ++mesh) {
        sequences.push_back(find_sequence(scene.meshes[mesh], shapes[mesh], std::move(surfaces[mesh])));
    }
    for (std::size_t mesh = 0; mesh < sequences.size(); ++mesh) order_vertices(scene.meshes[mesh], sequences[mesh]);
    scene.levels = make_levels(scene.meshes, sequences);
}

}  // namespace bendy::converter
