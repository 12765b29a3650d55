#include "optimise/passes/bone_order.h"

#include "optimise/passes/level_order.h"
#include "optimise/passes/mesh_order.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <numeric>
#include <utility>

namespace bendy::converter {
namespace {

/// The bones for which a vertex has weight, ascending.
void find_bones(const Mesh& mesh, std::size_t vertex, std::vector<std::uint32_t>& bones) {
    bones.clear();
    for (std::size_t k = vertex * mesh.influences; k < (vertex + 1) * mesh.influences; ++k) {
        if (mesh.weights[k] != 0.0f) bones.push_back(mesh.bones[k]);
    }
    std::sort(bones.begin(), bones.end());
    bones.erase(std::unique(bones.begin(), bones.end()), bones.end());
}

/// The vertex at each place.
std::vector<std::uint32_t> inverse(std::span<const std::uint32_t> places) {
    std::vector<std::uint32_t> order(places.size());
    for (std::uint32_t vertex = 0; vertex < places.size(); ++vertex) order[places[vertex]] = vertex;
    return order;
}

}  // namespace

BoneOrder::BoneOrder(const Mesh& mesh) {
    std::map<std::vector<std::uint32_t>, std::uint32_t> numbers;  // in order of occurrence
    std::vector<std::uint32_t> bones;
    auto last = numbers.end();
    set_of_.reserve(mesh.positions.size());
    for (std::size_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
        find_bones(mesh, vertex, bones);
        if (last == numbers.end() || last->first != bones)
            last = numbers.try_emplace(bones, static_cast<std::uint32_t>(numbers.size())).first;
        set_of_.push_back(last->second);
    }
    std::vector<std::uint32_t> rank(numbers.size());
    for (const auto& [set, number] : numbers) {
        rank[number] = static_cast<std::uint32_t>(sets_.size());
        sets_.push_back(set);
    }
    for (std::uint32_t& set : set_of_) set = rank[set];
}

std::vector<std::uint32_t> BoneOrder::sorted(std::span<const std::uint32_t> places) const {
    std::vector<std::uint32_t> next(sets_.size() + 1);
    for (const std::uint32_t set : set_of_) ++next[set + 1];
    std::partial_sum(next.begin(), next.end(), next.begin());
    std::vector<std::uint32_t> sorted(places.size());
    for (const std::uint32_t vertex : inverse(places)) sorted[vertex] = next[set_of_[vertex]]++;
    return sorted;
}

double BoneOrder::bones_of_eight(std::span<const std::uint32_t> places) const {
    constexpr std::size_t kNeighbours = 8;
    const std::vector<std::uint32_t> order = inverse(places);
    std::vector<std::uint32_t> bones;
    std::size_t sum = 0;
    std::size_t groups = 0;
    for (std::size_t first = 0; first < order.size(); first += kNeighbours, ++groups) {
        bones.clear();
        for (std::size_t at = first; at < std::min(first + kNeighbours, order.size()); ++at) {
            const std::uint32_t set = set_of_[order[at]];
            if (at != first && set == set_of_[order[at - 1]]) continue;
            bones.insert(bones.end(), sets_[set].begin(), sets_[set].end());
        }
        std::sort(bones.begin(), bones.end());
        sum += static_cast<std::size_t>(std::unique(bones.begin(), bones.end()) - bones.begin());
    }
    return groups == 0 ? 0.0 : static_cast<double>(sum) / static_cast<double>(groups);
}

void sort_by_bones(Scene& scene) {
    constexpr double kLeastSaved = 0.2;  // bones of eight neighbours: less is not worth two bytes a vertex
    for (std::uint32_t number = 0; number < scene.meshes.size(); ++number) {
        Mesh& mesh = scene.meshes[number];
        if (mesh.influences == 0) continue;
        const BoneOrder bones(mesh);
        std::vector<std::uint32_t> before(mesh.positions.size());
        std::iota(before.begin(), before.end(), 0u);
        std::vector<std::uint32_t> places = bones.sorted(before);
        const bool has_levels = !mesh.collapse.empty();
        if (has_levels) places = places_in_levels(mesh, places, levels_of(scene, number));
        if (bones.bones_of_eight(before) - bones.bones_of_eight(places) < kLeastSaved) continue;
        std::vector<std::uint32_t> order = inverse(places);
        permute_vertices(mesh, order);
        if (has_levels) {
            move_collapse(mesh, places);
        } else {
            mesh.source_numbers = std::move(order);
        }
    }
}

}  // namespace bendy::converter
