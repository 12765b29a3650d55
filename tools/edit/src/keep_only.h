#pragma once

#include "kept.h"

namespace bendy::edit {

/// Removes everything from the file that is not kept, and updates what refers to it.
Result<void, Problem> keep_only(const Source& source, const Kept& kept, Rewrite& rewrite, Log& log);

}  // namespace bendy::edit
