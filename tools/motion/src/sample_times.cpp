#include "sample_times.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>

namespace bendy::motion {
namespace {

constexpr double kRate = 120.0;          // samples per second
constexpr std::size_t kForKey = 16;      // samples per key
constexpr std::size_t kForClip = 1'000;  // and for a clip
constexpr float kApart = 0.0005f;        // seconds

std::vector<float> key_times(const Clip& clip) {
    std::vector<float> times{clip.start, clip.end};
    std::vector<const float*> known;  // tracks often share their times
    for (const TrackView& track : clip.tracks) {
        const bool jumps = track.interpolation == Interpolation::step;
        if (!track.times.empty() && !jumps) {
            if (!known.empty() && known.back() == track.times.data()) continue;
            known.push_back(track.times.data());
        }
        for (std::uint32_t k = 0; k < track.keys; ++k) {
            const float time =
                track.times.empty() ? clip.start + static_cast<float>(k) / clip.frame_rate : track.times[k];
            times.push_back(time);
            if (jumps && k > 0) times.push_back(std::nextafter(time, -std::numeric_limits<float>::infinity()));
        }
    }
    if (clip.packed) {
        for (std::uint32_t k = 0; k < clip.packed->record.frames; ++k)
            times.push_back(static_cast<float>(clip.packed->time_of(k)));
    }
    for (float& time : times) time = time >= clip.start ? std::min(time, clip.end) : clip.start;
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
}

/// Leaves out times that are nearly the same, jumps apart.
void thin(std::vector<float>& times) {
    std::size_t kept = 1;
    for (std::size_t k = 1; k < times.size(); ++k) {
        const bool jumps = std::nextafter(times[k - 1], times[k]) == times[k] ||
                           (k + 1 < times.size() && std::nextafter(times[k], times[k + 1]) == times[k + 1]);
        if (jumps || k + 1 == times.size() || times[k] - times[kept - 1] >= kApart) times[kept++] = times[k];
    }
    times.resize(kept);
}

}  // namespace

std::vector<float> sample_times(const Clip& clip, std::size_t most) {
    std::vector<float> keys = key_times(clip);
    thin(keys);
    const double length = double{clip.end} - clip.start;
    const double step = std::max(1.0 / kRate, length / static_cast<double>(kForClip + kForKey * keys.size()));
    std::vector<float> times;
    const auto fill = [&](double from, double to, std::size_t parts) {
        for (std::size_t k = 0; k < parts; ++k) {
            const auto time =
                static_cast<float>(from + (to - from) * static_cast<double>(k) / static_cast<double>(parts));
            if (times.empty() || time > times.back()) times.push_back(time);
        }
    };
    for (std::size_t k = 0; k + 1 < keys.size(); ++k) {
        const double gap = double{keys[k + 1]} - keys[k];
        const double parts = std::ceil(gap / step - 1e-3);  // not a number if the clip is endless
        fill(keys[k], keys[k + 1],
             parts > 1.0 ? static_cast<std::size_t>(std::min(parts, static_cast<double>(most))) : 1);
    }
    if (times.size() >= most) {
        times.clear();
        fill(clip.start, clip.end, most - 1);
    }
    if (times.empty() || clip.end > times.back()) times.push_back(clip.end);
    return times;
}

}  // namespace bendy::motion
