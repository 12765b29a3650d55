#pragma once

#include "compact/compact_geometry.h"

namespace bendy::converter {

/// Merges vertices that are alike in every stream, bone and displacement, to the bit.
void merge_vertices(Mesh& mesh, CompactMesh& compact);

/// Orders the triangles of each range of assign_polygons so that neighbours follow one another, and the vertices as
/// they are used first; the mesh's parts become these ranges. Lines and points keep their order.
void order_for_codecs(Mesh& mesh, CompactMesh& compact);

}  // namespace bendy::converter
