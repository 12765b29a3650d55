#pragma once

#include <algorithm>

namespace bendy {

/// From 0 to 1 between two numbers, of which the first may be the larger one.
inline double smooth(double number, double from, double to) {
    const double share = std::clamp((number - from) / (to - from), 0.0, 1.0);
    return share * share * (3.0 - 2.0 * share);
}

}  // namespace bendy
