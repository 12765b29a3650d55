#include "ticks.h"

#include "cycle_span.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace bendy::converter::x_out {
namespace {

/// Frame rates that animators use, and what X-files often have.
constexpr std::array<std::uint32_t, 14> kRates{24,  25,    30,    50,    60,    100,   120,
                                               240, 1'000, 3'000, 4'800, 6'000, 9'600, 48'000};
constexpr double kMostTicks = 2147483647.0;

bool is_left_out(const Cycle& cycle) {
    const CycleSpan span = span_of(cycle);
    return !(span.end + shift_of(cycle) <= Ticks::kLongest);
}

/// Not below 0, and a time that is not exact may be too large for the type.
std::uint64_t nearest(double time, std::uint32_t per_second) {
    return static_cast<std::uint64_t>(std::llround(std::clamp(time * per_second, 0.0, kMostTicks)));
}

}  // namespace

float shift_of(const Cycle& cycle) {
    const float start = span_of(cycle).start;
    return start < 0.0f ? -start : 0.0f;
}

Ticks::Ticks(const Scene& scene) {
    for (const std::uint32_t rate : kRates) {
        per_second_ = rate;
        if (is_exact(scene)) return;
    }
    double longest = 1.0;
    for (const Cycle& cycle : scene.cycles) {
        if (!is_left_out(cycle)) longest = std::max(longest, double{span_of(cycle).end + shift_of(cycle)});
    }
    per_second_ = 1;
    while (longest * per_second_ * 2 < kMostTicks / 2) per_second_ *= 2;
}

bool Ticks::is_exact(const Scene& scene) const {
    std::uint64_t rounded = 0;
    for (const Cycle& cycle : scene.cycles) {
        if (is_left_out(cycle)) continue;
        const float shift = shift_of(cycle);
        if (double{span_of(cycle).end + shift} * per_second_ > kMostTicks / 2) return false;
        for (const Track& track : cycle.tracks) {
            if (track.path == TrackPath::weights) continue;
            static_cast<void>(of(track.times, shift, rounded));
            if (rounded != 0) return false;
        }
    }
    return true;
}

std::vector<std::uint64_t> Ticks::of(const std::vector<float>& times, float shift, std::uint64_t& rounded) const {
    std::vector<std::uint64_t> ticks;
    ticks.reserve(times.size());
    for (const float time : times) {
        std::uint64_t tick = nearest(double{time} + shift, per_second_);
        if (!ticks.empty()) tick = std::max(tick, ticks.back() + 1);
        ticks.push_back(tick);
        if (static_cast<float>(seconds(tick)) != time + shift) ++rounded;
    }
    return ticks;
}

}  // namespace bendy::converter::x_out
