#pragma once

#include "plan/unpack_plain.h"

namespace bendy {

/// With the kernel in use.
Unpack unpack;

}  // namespace bendy
