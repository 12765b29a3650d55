#include "cycle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

namespace bendy::edit {
namespace {

constexpr double kRate = 30.0;       // samples per second
constexpr std::size_t kTracks = 64;  // that are looked at: joints near the root come first
constexpr double kLongest = 20.0;    // seconds that are looked at
constexpr double kShortest = 0.2;    // seconds of a cycle
constexpr double kAlike = 0.25;      // of the mean difference of two times
constexpr std::size_t kTheSame =
    2;  // samples within which the ends of a clip are alike: files leave out the last frame

using Rotations = std::vector<std::array<double, 4>>;

Rotations rotations_at(const ClipKeys& clip, double seconds) {
    Rotations rotations;
    for (const ClipTrack& track : clip.tracks) {
        if (!track.is_rotation || track.is_constant() || rotations.size() == kTracks) continue;
        sample(track, seconds, rotations.emplace_back());
    }
    return rotations;
}

double difference(const Rotations& a, const Rotations& b) {
    double sum = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        const double dot = std::inner_product(a[k].begin(), a[k].end(), b[k].begin(), 0.0);
        sum += std::max(0.0, 1.0 - dot * dot);
    }
    return sum;
}

/// Returns the mean difference of two samples, by how many samples there are between them.
std::vector<double> differences(const std::vector<Rotations>& samples) {
    std::vector<double> means{0.0};
    for (std::size_t shift = 1; shift <= samples.size() / 2; ++shift) {
        double sum = 0.0;
        for (std::size_t k = 0; k + shift < samples.size(); ++k) sum += difference(samples[k], samples[k + shift]);
        means.push_back(sum / static_cast<double>(samples.size() - shift));
    }
    return means;
}

}  // namespace

Cycle find_cycle(const ClipKeys& clip) {
    const double length = double{clip.end} - clip.start;
    const double step = 1.0 / kRate;
    std::vector<Rotations> samples;
    const auto count = static_cast<std::size_t>(std::min(length, kLongest) * kRate) + 1;
    for (std::size_t k = 0; k < count; ++k)
        samples.push_back(rotations_at(clip, clip.start + static_cast<double>(k) * step));
    const std::vector<double> by_shift = differences(samples);
    const double alike =
        kAlike * std::accumulate(by_shift.begin(), by_shift.end(), 0.0) / static_cast<double>(by_shift.size());
    Cycle cycle{{}, clip.loop};
    if (!(alike > 0.0)) return cycle;
    const double ends = difference(samples.front(), rotations_at(clip, clip.end));
    if (by_shift.size() > kTheSame) cycle.repeats = clip.loop || ends <= std::min(by_shift[kTheSame], alike);
    if (cycle.repeats) cycle.seconds = length;
    for (auto k = static_cast<std::size_t>(kShortest * kRate); k + 1 < by_shift.size(); ++k) {
        const double before = by_shift[k - 1], here = by_shift[k], after = by_shift[k + 1];
        if (here > before || here > after || here > alike) continue;
        const double curvature = before - 2.0 * here + after;  // of the parabola through the three
        const double off = curvature > 0.0 ? 0.5 * (before - after) / curvature : 0.0;
        cycle.seconds = std::min(length, (static_cast<double>(k) + off) * step);
        break;
    }
    return cycle;
}

}  // namespace bendy::edit
