#pragma once

#include "plan/unpack_plain.h"

namespace bendy {

/// Unpacks with the kernel in use. Sets all joints: those without a track to rest.
Unpack unpack;

}  // namespace bendy
