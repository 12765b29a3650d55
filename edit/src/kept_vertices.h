#pragma once

#include "kept.h"

namespace bendy::edit {

/// Marks in `kept` the vertices of each mesh that the submeshes of these joints use, and those that they collapse to; a
/// mesh without such submeshes is removed. A rigid mesh whose vertices collapse to vertices that are no longer used
/// loses its levels of detail.
void keep_used_vertices(const ObjectView& object, Kept::Object& kept);

/// Marks the joints that influence a kept vertex.
void keep_joints_of_vertices(const ObjectView& object, Kept::Object& kept);

}  // namespace bendy::edit
