#include "passes/sort_by_bones.h"

#include "passes/permute_vertices.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

namespace bendy::converter {
namespace {

/// The bones that any weight of a vertex goes to, ascending.
void find_bones(const Mesh& mesh, std::size_t vertex, std::vector<std::uint32_t>& bones) {
    bones.clear();
    for (std::size_t k = vertex * mesh.influences; k < (vertex + 1) * mesh.influences; ++k) {
        if (mesh.weights[k] != 0.0f) bones.push_back(mesh.bones[k]);
    }
    std::sort(bones.begin(), bones.end());
    bones.erase(std::unique(bones.begin(), bones.end()), bones.end());
}

}  // namespace

void sort_by_bones(Mesh& mesh) {
    if (mesh.influences == 0 || !mesh.collapse.empty()) return;
    std::map<std::vector<std::uint32_t>, std::uint32_t> sets;  // how many vertices follow these; then where they begin
    std::vector<std::uint32_t*> set_of;
    set_of.reserve(mesh.positions.size());
    std::vector<std::uint32_t> bones;
    for (std::size_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
        find_bones(mesh, vertex, bones);
        std::uint32_t& count = sets[bones];
        ++count;
        set_of.push_back(&count);
    }
    std::uint32_t first = 0;
    for (auto& [set, count] : sets) {
        const std::uint32_t here = count;
        count = first;
        first += here;
    }
    std::vector<std::uint32_t> order(set_of.size());
    for (std::uint32_t vertex = 0; vertex < set_of.size(); ++vertex) order[(*set_of[vertex])++] = vertex;
    if (!std::is_sorted(order.begin(), order.end())) permute_vertices(mesh, order);
}

}  // namespace bendy::converter
