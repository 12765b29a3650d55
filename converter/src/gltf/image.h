#pragma once

#include "document.h"

#include <bendy/converter/scene.h>

#include <cstddef>
#include <span>
#include <string>

namespace bendy::converter::gltf {

/// Fills Scene::images, in the file's order: encoded bytes as they came, or the URI of a file that is not embedded or
/// not there.
void import_images(const Document& document, bool embed, Scene& scene);

}  // namespace bendy::converter::gltf
