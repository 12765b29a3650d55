#pragma once

#include "gltf_out/buffer.h"
#include "json_text.h"

#include <bendy/converter/report.h>

namespace bendy::converter::gltf_out {

/// Puts accessors in place of the numbers that gltf::inline_instances has left in the nodes' EXT_mesh_gpu_instancing;
/// an extension without such numbers is left out, which is said.
void export_instances(Json& nodes, Buffer& buffer, Report& report);

}  // namespace bendy::converter::gltf_out
