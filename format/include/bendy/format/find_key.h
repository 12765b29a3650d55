#pragma once

#include <bendy/format/public.h>

#include <cstddef>

namespace BENDY_PUBLIC bendy {

/// Returns the number of the last of `count` ascending times that is not after `seconds`; 0 if all are after it. Most
/// times are evenly spaced: then the key is at the computed position or next to it, and nothing is searched. Stays
/// below `count`, which is at least 1, whatever the times are.
/// \param time_at  returns the time of a key, given its number
template <class TimeAt, class Seconds>
std::size_t find_key(std::size_t count, const TimeAt& time_at, Seconds seconds) {
    const std::size_t last = count - 1;
    const auto first_time = time_at(0);
    const auto last_time = time_at(last);
    if (!(first_time < seconds)) return 0;
    if (!(seconds < last_time)) return last;
    const auto most = static_cast<Seconds>(last);
    const auto guess = (seconds - first_time) / (last_time - first_time) * most;
    std::size_t left = guess < most ? static_cast<std::size_t>(guess) : last - 1;  // false for NaN too
    if (left > 0 && time_at(left) > seconds) --left;
    if (left + 1 < last && time_at(left + 1) <= seconds) ++left;
    if (time_at(left) <= seconds && time_at(left + 1) > seconds) return left;

    // No branch depends on a time, since none could be predicted for random moments.
    left = 0;
    for (std::size_t rest = count; rest > 1;) {
        const std::size_t half = rest / 2;
        left += time_at(left + half) <= seconds ? half : 0;
        rest -= half;
    }
    return left;
}

}  // namespace bendy
