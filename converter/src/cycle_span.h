#pragma once

#include "frame_shapes.h"

#include <bendy/converter/scene.h>

#include <algorithm>

namespace bendy::converter {

/// A cycle's first and last key time, in seconds; zeros where nothing moves.
struct CycleSpan {
    float start = 0.0f;
    float end = 0.0f;

    /// At a share of the way, 0 to 1; seconds.
    [[nodiscard]] double at(double share) const { return start + share * (double{end} - start); }
};

inline CycleSpan span_of(const Cycle& cycle) {
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

}  // namespace bendy::converter
