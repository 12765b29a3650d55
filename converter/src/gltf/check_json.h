#pragma once

#include "json_text.h"

#include <bendy/converter/report.h>

#include <string>
#include <string_view>

namespace bendy::converter::gltf {

/// Parses glTF's JSON and checks it: a 2.x asset, no required extension that is unknown (EXT_mesh_gpu_instancing is
/// known `with_instances`), and for everything that the importer reads that it is there, of the right type, finite, in
/// range, and that indices point at something. Integers written as `1.0` become integers, so that later readers need
/// not care. Fails with the JSON path.
Json parse_json(std::string_view text, bool with_instances, Report& report);

/// The member `key` of an object, or null.
const Json* find(const Json& object, const char* key);

/// The array `key` of the root; an empty one if it is not there.
const Json& array_of(const Json& root, const char* key);

/// An object's `extras` as compact JSON text, or empty.
std::string extras_text(const Json& object);

}  // namespace bendy::converter::gltf
