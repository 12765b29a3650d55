#pragma once

#include "optimise/compact/compact_geometry.h"
#include "optimise/compact/leaf_writer.h"

#include <bendy/converter/scene.h>

#include <cstdint>
#include <span>
#include <string>

namespace bendy::converter {

/// Writes a text leaf, unless the text is empty.
inline void put_text(LeafWriter& out, FourCC id, const std::string& text) {
    if (!text.empty()) out.text_leaf(id, text);
}

/// Writes VECT: a mesh with its streams, palette, indices and targets.
/// \param compact  the streams that are stored as integers
void put_mesh(LeafWriter& out, const Mesh& mesh, std::span<const std::uint32_t> indices, const CompactMesh& compact);

/// Writes LODD: the collapse sequences of all meshes that have one, and the levels.
void put_collapse(LeafWriter& out, const Scene& scene);

}  // namespace bendy::converter
