#pragma once

#include <bendy/converter/scene.h>

#include "collapse/sequence.h"

namespace bendy::converter {

/// Sorts a mesh's vertices so that those that are left longest come first, with all streams, targets and indices, and
/// fills Mesh::collapse, joined and base. A sequence without moves changes nothing.
void order_vertices(Mesh& mesh, const Sequence& sequence);

}  // namespace bendy::converter
