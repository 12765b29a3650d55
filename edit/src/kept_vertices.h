#pragma once

#include "kept.h"

namespace bendy::edit {

/// Marks in `kept` the vertices of each mesh that the polygons of these joints use, and those that they collapse to;
/// a mesh without such polygons goes. A rigid mesh whose vertices
/// collapse to such as are used no more keeps no levels of detail.
void keep_used_vertices(const ObjectView& object, Kept::Object& kept);

/// Marks the joints that have weight in a vertex that stays.
void keep_joints_of_vertices(const ObjectView& object, Kept::Object& kept);

}  // namespace bendy::edit
