#pragma once

#include <bendy/converter/scene.h>

#include <glm/vec3.hpp>

#include <vector>

namespace bendy::converter {

/// A mesh's vertices in one shape: posed, or with morph targets. Model space, metres, at the rest pose's scale.
using Shape = std::vector<glm::vec3>;

/// For each mesh, the shapes in which its simplification is measured. The first is the rest pose. Then, for skinned
/// meshes, up to eight poses of the clips that are farthest from one another, or synthetic ones if there are no clips;
/// then groups of morph targets at full weight. Large meshes get fewer.
std::vector<std::vector<Shape>> find_shapes(const Scene& scene);

}  // namespace bendy::converter
