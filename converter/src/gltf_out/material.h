#pragma once

#include "gltf_out/buffer.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

namespace bendy::converter::gltf_out {

/// Writes materials, textures, samplers and images, all with the scene's numbers, into the document `root`.
void export_materials(const Scene& scene, Json& root, Buffer& buffer, Report& report);

}  // namespace bendy::converter::gltf_out
