#pragma once

#include "rewrite.h"

#include <bendy/edit/outcome.h>

namespace bendy::edit {

/// Returns the file with its changes and with the counts in VERS updated; a problem if it would not be valid.
Edited finish(const Rewrite& rewrite);

}  // namespace bendy::edit
