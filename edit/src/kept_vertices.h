#pragma once

#include "staying.h"

namespace bendy::edit {

/// Marks in `staying` the vertices of each pool that the polygons of these joints use, and those that they collapse to;
/// a pool without such polygons goes. A rigid pool whose vertices
/// collapse to such as are used no more keeps no levels of detail.
void keep_used_vertices(const ObjectView& object, Staying::Object& staying);

/// Marks the joints that have weight in a vertex that stays.
void keep_joints_of_vertices(const ObjectView& object, Staying::Object& staying);

}  // namespace bendy::edit
