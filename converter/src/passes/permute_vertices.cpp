#include "passes/permute_vertices.h"

#include <cassert>
#include <cstddef>
#include <utility>

namespace bendy::converter {
namespace {

/// `stride` numbers or vectors a vertex.
template <class T>
void permute(std::vector<T>& stream, std::size_t stride, std::span<const std::uint32_t> order) {
    if (stream.empty()) return;
    std::vector<T> sorted;
    sorted.reserve(stream.size());
    for (const std::uint32_t old : order) {
        for (std::size_t k = 0; k < stride; ++k) sorted.push_back(stream[old * stride + k]);
    }
    stream = std::move(sorted);
}

}  // namespace

std::vector<std::uint32_t> permute_vertices(Mesh& mesh, std::span<const std::uint32_t> order) {
    std::vector<std::uint32_t> number(mesh.positions.size(), kNone);
    for (std::uint32_t at = 0; at < order.size(); ++at) number[order[at]] = at;
    permute(mesh.positions, 1, order);
    permute(mesh.normals, 1, order);
    permute(mesh.tangents, 1, order);
    for (auto* streams : {&mesh.texture_coords, &mesh.colours, &mesh.attributes}) {
        for (Stream& stream : *streams) permute(stream.values, stream.components, order);
    }
    permute(mesh.bones, mesh.influences, order);
    permute(mesh.weights, mesh.influences, order);
    for (Target& target : mesh.targets) {
        permute(target.positions, 1, order);
        permute(target.normals, 1, order);
        permute(target.tangents, 1, order);
    }
    for (Part& part : mesh.parts) {
        for (std::uint32_t& index : part.indices) {
            assert(number[index] != kNone);
            index = number[index];
        }
    }
    return number;
}

}  // namespace bendy::converter
