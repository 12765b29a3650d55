#pragma once

#include "source/source_file.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>
#include <bendy/format/document.h>

namespace bendy::converter {

/// Fills scene.meshes from an object's pools and its joints' polygons, one mesh a pool. The document passes
/// check_values.
void import_pools(const ChunkTree& tree, const ObjectView& object, Budget& budget, Scene& scene, Report& report);

}  // namespace bendy::converter
