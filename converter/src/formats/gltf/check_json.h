#pragma once

#include "scene/json_text.h"

#include <bendy/converter/report.h>

#include <string>
#include <string_view>

namespace bendy::converter::gltf {

/// Parses glTF's JSON and checks it: a 2.x asset, no unknown required extension (EXT_mesh_gpu_instancing is known if
/// `with_instances`); everything that the importer reads has the right type and range, is present and finite, and every
/// index refers to an existing element. Integers written as `1.0` become integers, so that later readers need not
/// handle them. Fails with the JSON path.
Json parse_json(std::string_view text, bool with_instances, Report& report);

/// The member `key` of an object, or null.
const Json* find(const Json& object, const char* key);

/// The array `key` of the root; an empty one if it is missing.
const Json& array_of(const Json& root, const char* key);

/// An object's `extras` as compact JSON text, or empty.
std::string extras_text(const Json& object);

}  // namespace bendy::converter::gltf
