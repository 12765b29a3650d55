#pragma once

#include "document.h"
#include "skeleton.h"

#include <bendy/converter/scene.h>

namespace bendy::converter::gltf {

/// Fills `more` of the scene's joints, materials, textures and cycles, and of its root: what the file says of them that
/// no field holds, and the names and extras of skins, cameras, samplers and images with those that use them.
void keep_members(const Document& document, const Skeleton& skeleton, Scene& scene);

/// Names in warnings what of the file is not in the scene: what nothing uses, and members of storage and motion.
void report_left_out(const Document& document, const Skeleton& skeleton);

}  // namespace bendy::converter::gltf
