#pragma once

#include "scene/progress.h"

#include <bendy/converter/scene.h>

namespace bendy::converter {

/// Computes the sequence in which each mesh's vertices collapse, as far as it goes, and orders the vertices, streams,
/// targets and indices by it: Mesh::collapse, joined, base, and Scene::levels. No triangle changes at full detail. A
/// mesh that cannot collapse is unchanged. Takes O(n log n) time; the same scene gives the same order.
void collapse_vertices(Scene& scene, const Progress& progress = {});

}  // namespace bendy::converter
