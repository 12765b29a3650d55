#pragma once

#include "plan/unpack_plan.h"

#include <cstddef>
#include <span>

namespace bendy {

/// Sets the properties that the tracks animate to their values at `seconds`. Does nothing if the tracks are of a model
/// with more joints.
/// \param joints  in `local`
/// \param local   UnpackPlan::start
void unpack(const UnpackPlan& plan, float seconds, std::size_t joints, std::span<JointBlock> local);

}  // namespace bendy
