#pragma once

#include "rewrite.h"

#include <bendy/edit/outcome.h>

namespace bendy::edit {

/// The file with its changes and with the counts of VERS renewed; a problem if it would not be valid.
Edited finish(const Rewrite& rewrite);

}  // namespace bendy::edit
