#include "compact/thin_grid.h"

#include "compact/affine.h"
#include "evaluate.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace bendy::converter {
namespace {

constexpr std::uint32_t kFewest = 12;  // frames that must be left

/// Metres in the parent's space by which two values of a joint differ, at its probes.
double difference(const Local& a, const Local& b, TrackPath path, double reach) {
    if (path == TrackPath::translation) return glm::length(a.translation - b.translation);
    if (path == TrackPath::scale) return glm::length(a.scale - b.scale) * reach;
    const double sign = glm::dot(a.rotation, b.rotation) < 0.0 ? -1.0 : 1.0;
    const glm::dquat off = a.rotation - b.rotation * sign;
    return 2.0 * std::sqrt(glm::dot(off, off)) * reach;
}

/// Between two values; a chord, near enough to the arc for what is told apart here.
Local between(const Local& a, const Local& b, double u) {
    Local found = a;
    found.translation = a.translation * (1.0 - u) + b.translation * u;
    found.scale = a.scale * (1.0 - u) + b.scale * u;
    const double sign = glm::dot(a.rotation, b.rotation) < 0.0 ? -1.0 : 1.0;
    found.rotation = glm::normalize(a.rotation * (1.0 - u) + b.rotation * (sign * u));
    return found;
}

double error_of(const Track& track, const Local& rest, const Grid& from, const Grid& to, double reach, double most) {
    std::vector<Local> kept(to.frames, rest);
    std::vector<double> value;
    for (std::uint32_t f = 0; f < to.frames; ++f) {
        evaluate_track(track, to.time_of(f), value);
        set_property(track.path, value, kept[f]);
    }
    double worst = 0.0;
    for (std::uint32_t f = 0; f < from.frames && worst <= most; ++f) {
        Local exact = rest;
        evaluate_track(track, snapped(track, from.time_of(f), from.snap()), value);
        set_property(track.path, value, exact);
        const double at = std::max(0.0, (from.time_of(f) - to.start) * to.rate);
        const auto left = std::min(static_cast<std::uint32_t>(at), to.frames - 2);
        const Local found = between(kept[left], kept[left + 1], std::min(at - left, 1.0));
        worst = std::max(worst, difference(exact, found, track.path, reach));
    }
    return worst;
}

}  // namespace

std::optional<ThinGrid> thin_grid(const Scene& scene, const Cycle& cycle, const GridTracks& tracks, std::uint32_t fewer,
                                  const std::vector<std::vector<glm::dvec3>>& probes, double most) {
    const Grid& old = tracks.grid;
    const std::uint32_t frames = (old.frames - 1 + fewer / 2) / fewer + 1;
    if (old.rate == 0.0f || frames < kFewest) return std::nullopt;
    ThinGrid thin{old, 0.0};
    thin.grid.frames = frames;
    thin.grid.rate = static_cast<float>(double{old.rate} * (frames - 1) / (old.frames - 1));
    for (const std::uint32_t number : tracks.tracks) {
        const Track& track = cycle.tracks[number];
        double reach = 0.0;
        for (const glm::dvec3& probe : probes[track.target]) reach = std::max(reach, glm::length(probe));
        const Local rest = local_of(scene.joints[track.target].rest);
        thin.error = std::max(thin.error, error_of(track, rest, old, thin.grid, reach, most));
        if (thin.error > most) return std::nullopt;
    }
    return thin;
}

}  // namespace bendy::converter
