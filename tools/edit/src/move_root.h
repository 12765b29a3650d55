#pragma once

#include "clip_keys.h"

#include <bendy/edit/edit.h>

#include <string_view>

namespace bendy::edit {

/// Takes the movement over the ground, along x and z of the model, from a joint, and gives it to one above it or to
/// none. The movement is the one that RootPath finds: the distance from the place at rest. \param from  a joint; empty:
/// the highest one that moves, down to the hips \param to    a joint above it; empty: none
Result<void, Problem> move_root(ClipKeys& clip, std::string_view from, std::string_view to, Log& log);

/// Takes the way over the ground out of the highest joint that moves, down to the hips: the mean of its movement over a
/// window around each time. \param window  seconds, not longer than the clip; 0: one cycle of the clip
Result<void, Problem> keep_on_the_spot(ClipKeys& clip, double window, Log& log);

}  // namespace bendy::edit
