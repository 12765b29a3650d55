#pragma once

#include "scene/source/source_file.h"

#include <bendy/converter/import.h>
#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>
#include <bendy/format/document.h>

namespace bendy::converter {

/// Fills scene.meshes from an object's meshes and its joints' polygons, one mesh per stored mesh. The document must
/// pass check_values.
void import_stored_meshes(const ChunkTree& tree, const ObjectView& object, MeshParts parts, Budget& budget,
                          Scene& scene, Report& report);

}  // namespace bendy::converter
