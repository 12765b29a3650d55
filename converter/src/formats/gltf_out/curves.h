#pragma once

#include "formats/gltf_out/buffer.h"
#include "formats/gltf_out/parts.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <cstdint>
#include <span>

namespace bendy::converter::gltf_out {

/// Adds the clips' curves to their animations in the document `root`, which is otherwise complete: as channels of
/// KHR_animation_pointer. A curve whose property does not exist in the document is left out with a warning, as is an
/// animation that has no channels then.
/// \param animation_of_clip  see ExportedAnimations
/// \param node_of_mesh        see ExportedMeshes
void export_curves(const Scene& scene, std::span<const std::uint32_t> animation_of_clip,
                   std::span<const std::uint32_t> node_of_mesh, Json& root, Buffer& buffer, Report& report);

}  // namespace bendy::converter::gltf_out
