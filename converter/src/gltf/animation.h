#pragma once

#include "document.h"
#include "mesh.h"
#include "skeleton.h"

#include <bendy/converter/scene.h>

namespace bendy::converter::gltf {

/// Fills Scene::cycles: one for each animation of the file, in its order, even if nothing in it moves the scene. Keys
/// stay as they are, but for rotations that are no unit quaternions.
void import_animations(const Document& document, const Skeleton& skeleton, const MeshesOfNode& meshes, Scene& scene);

}  // namespace bendy::converter::gltf
