#pragma once

#include "document.h"
#include "skeleton.h"

#include <bendy/converter/scene.h>

#include <cstdint>
#include <vector>

namespace bendy::converter::gltf {

/// The meshes that a node became, by node: none, one, or one per layout of streams among its primitives.
using MeshesOfNode = std::vector<std::vector<std::uint32_t>>;

/// Fills Scene::meshes from the drawn nodes with a mesh. Primitives with the same layout become parts of one mesh;
/// those that name the very same accessors share their vertices. A mesh that several nodes use is made once for each.
MeshesOfNode import_meshes(const Document& document, const Skeleton& skeleton, Scene& scene);

}  // namespace bendy::converter::gltf
