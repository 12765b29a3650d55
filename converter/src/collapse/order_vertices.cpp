#include "collapse/order_vertices.h"

#include "passes/permute_vertices.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bendy::converter {

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

}  // namespace bendy::converter
