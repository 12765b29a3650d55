#pragma once

#include <bendy/converter/scene.h>

#include <cstddef>
#include <vector>

namespace bendy::converter {

/// Marks the palette entries that move a vertex of the mesh. Marks that are there stay.
inline void mark_used(const Mesh& mesh, std::vector<bool>& used) {
    used.resize(mesh.palette.joints.size());
    for (std::size_t at = 0; at < mesh.weights.size(); ++at) {
        if (mesh.weights[at] != 0.0f) used[mesh.bones[at]] = true;
    }
}

}  // namespace bendy::converter
