#pragma once

#include "compact/compact_geometry.h"
#include "compact/leaf_writer.h"

#include <bendy/converter/scene.h>

#include <cstdint>
#include <span>
#include <string>

namespace bendy::converter {

/// A leaf of text, where there is any.
inline void put_text(LeafWriter& out, FourCC id, const std::string& text) {
    if (!text.empty()) out.text_leaf(id, text);
}

/// VECT: a mesh with its streams, palette, indices and targets. \param compact  what of it is stored as integers
void put_mesh(LeafWriter& out, const Mesh& mesh, std::span<const std::uint32_t> indices, const CompactMesh& compact);

/// LODD: the collapse sequences of all meshes that have one, and the levels.
void put_collapse(LeafWriter& out, const Scene& scene);

}  // namespace bendy::converter
