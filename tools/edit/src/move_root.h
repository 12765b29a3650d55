#pragma once

#include "clip_keys.h"

#include <bendy/edit/edit.h>

#include <string_view>

namespace bendy::edit {

/// Takes the movement over the ground, along x and z of the model, from a joint, and gives it to one above it or to
/// none. The movement is the one that RootPath finds: the distance from the place at rest. \param from  a joint; empty:
/// the highest one that moves, down to the hips \param to    a joint above it; empty: none
Result<void, Problem> move_root(ClipKeys& clip, std::string_view from, std::string_view to, Log& log);

}  // namespace bendy::edit
