#pragma once

#include "clip_keys.h"

#include <optional>

namespace bendy::edit {

struct Cycle {
    std::optional<double> seconds;  ///< after which rotations are those of before, as after two steps of a walk
    bool repeats = false;           ///< the clip repeats, or ends as it begins
};

/// Finds the shortest time after which the first 20 seconds of a clip resemble themselves; if there is none, it is the
/// clip's length if it repeats.
Cycle find_cycle(const ClipKeys& clip);

}  // namespace bendy::edit
