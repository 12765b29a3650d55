#pragma once

#include "frame_shapes.h"

#include <bendy/converter/scene.h>

#include <algorithm>

namespace bendy::converter {

/// From the first to the last key of the tracks, packed ones apart; zeros where there are none.
inline CycleSpan span_of_keys(const Cycle& cycle) {
    CycleSpan span;
    bool is_first = true;
    for (const Track& track : cycle.tracks) {
        span.start = is_first ? track.times.front() : std::min(span.start, track.times.front());
        span.end = is_first ? track.times.back() : std::max(span.end, track.times.back());
        is_first = false;
    }
    for (const Play& play : cycle.plays) {
        const auto end = static_cast<float>(cycle.frame_start + length_of(cycle, play));
        span.start = is_first ? cycle.frame_start : std::min(span.start, cycle.frame_start);
        span.end = is_first ? end : std::max(span.end, end);
        is_first = false;
    }
    return span;
}

/// When the clip begins and ends: with its first and last key, or as it states.
inline CycleSpan span_of(const Cycle& cycle) {
    const CycleSpan keys = span_of_keys(cycle);
    if (!cycle.stated_span) return keys;
    if (cycle.tracks.empty() && cycle.plays.empty()) return *cycle.stated_span;
    return {std::min(keys.start, cycle.stated_span->start), std::max(keys.end, cycle.stated_span->end)};
}

}  // namespace bendy::converter
