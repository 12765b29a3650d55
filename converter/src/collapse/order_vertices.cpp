#include "collapse/order_vertices.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace bendy::converter {
namespace {

/// `stride` numbers or vectors a vertex; `order`: the old number of each new one.
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
    std::vector<std::uint32_t> number(vertices);
    for (std::uint32_t at = 0; at < vertices; ++at) number[order[at]] = at;

    mesh.collapse.resize(vertices);
    mesh.joined.assign(vertices, 0);
    for (std::uint32_t vertex = 0; vertex < mesh.base; ++vertex) mesh.collapse[vertex] = vertex;
    for (const VertexMove& move : sequence.moves) {
        mesh.collapse[number[move.from]] = number[move.to];
        mesh.joined[number[move.from]] = move.is_joined ? 1 : 0;
    }
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
        for (std::uint32_t& index : part.indices) index = number[index];
    }
}

}  // namespace bendy::converter
