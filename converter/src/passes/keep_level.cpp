#include "passes/keep_level.h"

#include "failure.h"
#include "passes/permute_vertices.h"

#include <array>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace bendy::converter {
namespace {

bool has_area(const std::array<std::uint32_t, 3>& corners) {
    return corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0];
}

/// The corners where `now` says that they are; triangles without area that had one go.
std::vector<std::uint32_t> moved(const Part& part, std::span<const std::uint32_t> now) {
    std::vector<std::uint32_t> indices;
    indices.reserve(part.indices.size());
    if (part.topology != Topology::triangles) {
        for (const std::uint32_t index : part.indices) indices.push_back(now[index]);
        return indices;
    }
    for (std::size_t k = 0; k + 2 < part.indices.size(); k += 3) {
        const std::array before{part.indices[k], part.indices[k + 1], part.indices[k + 2]};
        const std::array after{now[before[0]], now[before[1]], now[before[2]]};
        if (has_area(after) || !has_area(before)) indices.insert(indices.end(), after.begin(), after.end());
    }
    return indices;
}

void keep_first(Mesh& mesh, std::uint32_t vertices) {
    std::vector<std::uint32_t> now(mesh.positions.size());
    std::iota(now.begin(), now.end(), 0u);
    for (std::size_t vertex = vertices; vertex < now.size(); ++vertex) now[vertex] = now[mesh.collapse[vertex]];
    for (Part& part : mesh.parts) part.indices = moved(part, now);
    now.resize(vertices);
    permute_vertices(mesh, now);
}

}  // namespace

void keep_level(Scene& scene, std::span<const std::uint32_t> vertices) {
    if (vertices.size() != scene.meshes.size()) fail({}, "the level of detail is one of another file");
    for (std::size_t m = 0; m < vertices.size(); ++m) {
        Mesh& mesh = scene.meshes[m];
        const std::size_t least = mesh.collapse.empty() ? mesh.positions.size() : mesh.base;
        if (vertices[m] < least || vertices[m] > mesh.positions.size())
            fail(at("meshes", m), "there is no level of detail with " + std::to_string(vertices[m]) + " vertices");
        if (vertices[m] < mesh.positions.size()) keep_first(mesh, vertices[m]);
        mesh.collapse.clear();
        mesh.joined.clear();
        mesh.base = 0;
    }
    scene.levels.clear();
}

}  // namespace bendy::converter
