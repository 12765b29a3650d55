#pragma once

#include <bendy/converter/scene.h>

#include <cstddef>

namespace bendy::converter {

/// Calls visit(vector, entries per vertex) for every per-vertex vector of a mesh but those of its collapse sequence.
/// A vector may be empty.
template <class AnyMesh, class Visit>
void for_each_stream(AnyMesh& mesh, const Visit& visit) {
    constexpr std::size_t kOne = 1;
    visit(mesh.positions, kOne);
    visit(mesh.normals, kOne);
    visit(mesh.tangents, kOne);
    for (auto* streams : {&mesh.texture_coords, &mesh.colours, &mesh.attributes}) {
        for (auto& stream : *streams) visit(stream.values, std::size_t{stream.components});
    }
    visit(mesh.bones, std::size_t{mesh.influences});
    visit(mesh.weights, std::size_t{mesh.influences});
    visit(mesh.source_numbers, kOne);
    for (auto& target : mesh.targets) {
        visit(target.positions, kOne);
        visit(target.normals, kOne);
        visit(target.tangents, kOne);
    }
}

}  // namespace bendy::converter
