#pragma once

#include "retarget_plan.h"

#include <bendy/runtime/retarget.h>

#include <optional>

namespace bendy {

struct PoseState;

/// Moves joints that the skeleton does not hold to where the body has them.
void place_detached(const RetargetPlan& plan, PoseState& target);

/// Brings a retargeted pose inside the target's constraints, and hands and feet to their places.
Retargeted settle(RetargetPlan& plan, Pose& source, Pose& pose, RetargetState& state,
                  const std::optional<ContactWeights>& contacts);

}  // namespace bendy
