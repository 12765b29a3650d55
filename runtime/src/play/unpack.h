#pragma once

#include "plan/unpack_plain.h"

namespace bendy {

/// Unpacks with the kernel in use.
Unpack unpack;

}  // namespace bendy
