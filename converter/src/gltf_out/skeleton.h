#pragma once

#include "json_text.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

namespace bendy::converter::gltf_out {

/// The author's own JSON as a member of `object`; what is no JSON is named in the report.
void add_extras(Json& object, const std::string& extras, const std::string& place, Report& report);
/// Extensions that were kept as they came.
void add_extensions(Json& object, const std::string& extensions, const std::string& place, Report& report);

/// One node for each joint, of the same number, with its rest transform.
Json export_nodes(const Scene& scene, Report& report);

/// The roots, in order.
Json root_nodes(const Scene& scene);

}  // namespace bendy::converter::gltf_out
