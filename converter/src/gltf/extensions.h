#pragma once

#include "check_json.h"

#include <bendy/converter/report.h>

#include <string_view>

namespace bendy::converter::gltf {

/// A node draws its mesh several times: numbers that are kept, or joints (GltfOptions::instances).
inline constexpr std::string_view kInstancing = "EXT_mesh_gpu_instancing";

/// Whether a file that requires this extension can be imported: it is decoded, or it cannot change shape or motion.
bool is_known_extension(std::string_view name);

/// Whether a material extension becomes fields of Material; the others are kept there as JSON.
bool is_interpreted_material_extension(std::string_view name);

/// Warns of everything in the file that has no place in the Scene: by extension name, each with how often it occurs.
void report_extensions(const Json& root, Report& report);

}  // namespace bendy::converter::gltf
