#pragma once

#include "plan/unpack_plan.h"

namespace bendy {

/// Unpacks with the kernel in use.
Unpack unpack;

}  // namespace bendy
