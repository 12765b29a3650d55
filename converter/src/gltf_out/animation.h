#pragma once

#include "gltf_out/buffer.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <cstdint>
#include <span>

namespace bendy::converter::gltf_out {

/// Writes the scene's cycles, each as an animation. \param node_of_mesh  see ExportedMeshes
Json export_animations(const Scene& scene, std::span<const std::uint32_t> node_of_mesh, Buffer& buffer, Report& report);

}  // namespace bendy::converter::gltf_out
