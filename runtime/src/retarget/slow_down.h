#pragma once

#include "retarget_plan.h"

namespace bendy {

struct PoseState;

/// Turns joints that jump where the source does not only as far as kTurnSpeed allows, and remembers the frame.
/// \param seconds  since the last frame; more than 0
void slow_down(const RetargetPlan& plan, const PoseState& source, PoseState& target, RetargetState& state,
               float seconds);

}  // namespace bendy
