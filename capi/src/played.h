#pragma once

#include "fail.h"

#include <bendy.h>
#include <bendy/runtime/playback.h>

// Intervals that a clock has played, from and to C.
namespace bendy::capi {

/// Number of values of bendy_easing.
inline constexpr std::uint32_t kEasings = BENDY_EASING_SMOOTH + 1;

inline bendy_time_span to_c(const TimeSpan& span) {
    return {span.from, span.to, span.has_end ? 1U : 0U, 0};
}

inline bendy_played to_c(const PlayedInterval& played) {
    return {0, played.turns ? 1U : 0U, to_c(played.first), to_c(played.pass), played.passes, to_c(played.last)};
}

inline TimeSpan from_c(const bendy_time_span& span) {
    return {span.from, span.to, span.has_end != 0};
}

inline bendy_status take_played(const bendy_played* played, PlayedInterval& taken, bendy_error* error) {
    if (const bendy_status status = check_pointer(played, "played", error)) return status;
    bendy_played values{};
    if (const bendy_status status = take(played, "played", values, error)) return status;
    const double times[]{values.first.from, values.first.to,  values.pass.from,
                         values.pass.to,    values.last.from, values.last.to};
    if (const bendy_status status = check_finite(times, "played", error)) return status;
    taken = {from_c(values.first), from_c(values.pass), values.passes, values.turns != 0, from_c(values.last)};
    return BENDY_OK;
}

/// Checks a double that a call takes, such as seconds.
inline bendy_status check_double(double number, const char* name, bendy_error* error) {
    return check_finite(std::span<const double>(&number, 1), name, error);
}

}  // namespace bendy::capi
