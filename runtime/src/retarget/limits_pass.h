#pragma once

#include "settled_frame.h"

#include <bendy/runtime/model.h>

namespace bendy {

/// Constrains the joints from the trunk outwards. What a limit holds back, the joints below make up for: a hand
/// keeps its orientation in space even if the elbow cannot turn.
void constrain_all(SettledFrame& frame);

/// Returns the angle by which the joint was turned back, radians.
double constrain(SettledFrame& frame, const Constraint& constraint);

/// Returns true if a constraint is only a guess, beyond which a joint may go.
bool is_soft(const SettledFrame& frame, const Constraint& constraint);

/// Returns true if solvers obey the limits of a limb: not where all are soft.
bool obeys_limits(const SettledFrame& frame, const LimbPlan& plan);

}  // namespace bendy
