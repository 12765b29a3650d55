#pragma once

#include "document.h"

#include <bendy/converter/scene.h>

namespace bendy::converter::gltf {

/// Fills Scene::materials and Scene::textures, in the file's order. Material extensions without a field stay as JSON.
void import_materials(const Document& document, Scene& scene);

}  // namespace bendy::converter::gltf
