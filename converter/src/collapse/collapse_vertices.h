#pragma once

#include "progress.h"

#include <bendy/converter/scene.h>

namespace bendy::converter {

/// Computes the sequence in which each mesh's vertices are collapsed, down to as few as it goes, and orders the
/// vertices, streams, targets and indices by it: Mesh::collapse, joined, base, and Scene::levels. No triangle is
/// changed at full detail. O(n log n); the same scene gives the same order. A mesh of which nothing can collapse is
/// left as it is.
void collapse_vertices(Scene& scene, const Progress& progress = {});

}  // namespace bendy::converter
