#pragma once

#include "retarget_plan.h"

#include <bendy/runtime/retarget.h>

#include <optional>

namespace bendy {

/// Brings a retargeted pose inside the target's constraints, and hands and feet to their places.
Retargeted settle(const RetargetPlan& plan, Pose& source, Pose& pose, RetargetState& state,
                  const std::optional<ContactWeights>& contacts);

}  // namespace bendy
