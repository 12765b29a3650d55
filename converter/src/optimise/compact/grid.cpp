#include "optimise/compact/grid.h"

#include "scene/evaluate.h"
#include "scene/frame_shapes.h"
#include "scene/space.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace bendy::converter {
namespace {

constexpr std::uint32_t kDenser = 4;  // grids up to this many times denser than the densest track are tried

bool is_packable(const Track& track) {
    return track.path != TrackPath::weights && track.interpolation == Interpolation::linear;
}

bool is_constant(const Track& track) {
    const std::size_t n = track.components;
    for (std::size_t at = n; at < track.values.size(); ++at) {
        if (track.values[at] != track.values[at - n]) return false;
    }
    return true;
}

bool is_on_grid(const Track& track, double start, double rate) {
    return std::all_of(track.times.begin(), track.times.end(), [&](float time) {
        const double frame = (double{time} - start) * rate;
        return frame > -kGridTolerance && std::abs(frame - std::nearbyint(frame)) <= kGridTolerance;
    });
}

/// Frames per second of a track's keys, if evenly spaced on a grid up to `denser` times finer.
std::optional<double> rate_of(const Track& track, double most_frames) {
    const std::size_t last = track.times.size() - 1;
    double shortest = double{track.times[last]} - track.times[0];
    for (std::size_t k = 1; k <= last; ++k) shortest = std::min(shortest, double{track.times[k]} - track.times[k - 1]);
    if (!(shortest > 0.0)) return std::nullopt;
    // The shortest step is imprecise, the total length is not: count the frames in it.
    const double length = double{track.times[last]} - track.times[0];
    double rate = 1.0 / shortest;
    double frames = 0.0;
    for (std::size_t k = 1; k <= last; ++k) {
        frames += std::nearbyint((double{track.times[k]} - track.times[k - 1]) * rate);
        // At powers of two, re-estimate the rate from the frames counted so far, which is more precise than one step.
        if ((k & (k - 1)) == 0) rate = frames / (double{track.times[k]} - track.times[0]);
    }
    rate = frames / length;
    if (!(rate > 0.0) || !(frames < most_frames)) return std::nullopt;
    return rate;
}

/// The tracks of a clip, sorted for finding a grid.
struct Tracks {
    std::vector<std::uint32_t> still;   // numbers of tracks that never change
    std::vector<std::uint32_t> moving;  // numbers of tracks that change and can be packed
    const Track* densest = nullptr;     // among the moving ones
    ClipSpan span;
};

Tracks sort_tracks(const Clip& clip, const std::vector<bool>& still) {
    Tracks tracks;
    tracks.span = span_of(clip);
    for (std::uint32_t number = 0; number < clip.tracks.size(); ++number) {
        const Track& track = clip.tracks[number];
        const bool is_still = number < still.size() && still[number];
        if (!is_packable(track) && !is_still) continue;
        if (is_still || is_constant(track)) {
            tracks.still.push_back(number);
            continue;
        }
        tracks.moving.push_back(number);
        if (tracks.densest == nullptr || track.times.size() > tracks.densest->times.size()) tracks.densest = &track;
    }
    return tracks;
}

/// One frame, or two that span the clip: for constant tracks.
Grid still_grid(const Tracks& tracks) {
    const auto [start, end] = tracks.span;
    const auto rate = static_cast<float>(1.0 / (double{end} - start));
    const bool lasts = end > start && std::isfinite(rate);
    return {start, lasts ? rate : 1.0f, lasts ? 2u : 1u};
}

/// The even grid that holds most of the moving tracks, and those tracks.
GridTracks even_grid(const Clip& clip, const Tracks& tracks, double most_frames) {
    GridTracks found;
    const std::optional<double> base = rate_of(*tracks.densest, most_frames);
    if (!base || !std::isfinite(static_cast<float>(*base * kDenser))) return found;
    for (std::uint32_t denser = 1; denser <= kDenser; ++denser) {
        const double rate = *base * denser;
        const double first = tracks.densest->times.front();
        const double origin = first - std::nearbyint((first - tracks.span.start) * rate) / rate;
        std::vector<std::uint32_t> held;
        double last = origin;
        for (const std::uint32_t number : tracks.moving) {
            const Track& track = clip.tracks[number];
            if (!is_on_grid(track, origin, rate)) continue;
            held.push_back(number);
            last = std::max(last, double{track.times.back()});
        }
        const double frames = std::nearbyint((last - origin) * rate);
        if (held.size() <= found.tracks.size() || !(frames < most_frames)) continue;
        found.grid = {static_cast<float>(origin), static_cast<float>(rate), static_cast<std::uint32_t>(frames) + 1};
        found.tracks = std::move(held);
    }
    return found;
}

/// All key times of the moving tracks; no frames if there are many more than any single track has.
Grid uneven_grid(const Clip& clip, const Tracks& tracks, std::size_t most_frames) {
    constexpr std::size_t kMore = 2;
    Grid grid{0.0f, 0.0f, 0, {}};
    const std::vector<float>* before = nullptr;
    for (const std::uint32_t number : tracks.moving) {
        const std::vector<float>& times = clip.tracks[number].times;
        if (before != nullptr && *before == times) continue;
        before = &times;
        grid.times.insert(grid.times.end(), times.begin(), times.end());
    }
    std::sort(grid.times.begin(), grid.times.end());
    grid.times.erase(std::unique(grid.times.begin(), grid.times.end()), grid.times.end());
    if (grid.times.size() > std::min(kMore * tracks.densest->times.size(), most_frames)) return {0.0f, 0.0f, 0, {}};
    grid.start = grid.times.front();
    grid.frames = static_cast<std::uint32_t>(grid.times.size());
    return grid;
}

}  // namespace

double snapped(const Track& track, double seconds, double snap) {
    const auto after = std::upper_bound(track.times.begin(), track.times.end(), seconds + snap);
    if (after == track.times.begin()) return seconds;
    const double key = *(after - 1);
    return seconds - key <= snap ? key : seconds;
}

double Grid::snap() const {
    return rate != 0.0f ? kGridTolerance / rate : 0.0;
}

std::vector<GridTracks> find_grids(const Clip& clip, std::size_t most_frames, const std::vector<bool>& still) {
    const Tracks tracks = sort_tracks(clip, still);
    std::vector<GridTracks> found;
    if (!tracks.moving.empty()) {
        // A few keys between the others make an even grid needlessly dense: a listed time takes less than a frame.
        constexpr std::uint32_t kSparse = 2;
        GridTracks even = even_grid(clip, tracks, static_cast<double>(most_frames));
        GridTracks uneven{uneven_grid(clip, tracks, most_frames), tracks.moving};
        const bool is_even = !even.tracks.empty();
        const bool is_uneven = uneven.grid.frames > 1;
        const bool is_best = is_even && (!is_uneven || (even.tracks.size() == tracks.moving.size() &&
                                                        even.grid.frames / kSparse < uneven.grid.frames));
        if (is_best) found.push_back(std::move(even));
        if (is_uneven) found.push_back(std::move(uneven));
    }
    if (found.empty() && !tracks.still.empty()) found.push_back({still_grid(tracks), {}});
    for (GridTracks& grid : found) {
        grid.tracks.insert(grid.tracks.end(), tracks.still.begin(), tracks.still.end());
        std::sort(grid.tracks.begin(), grid.tracks.end());
    }
    return found;
}

namespace {

constexpr std::uint32_t kFewest = 12;  // minimum number of frames left

/// The length of the linear part's longest column: the most by which it lengthens a vector, unless it shears.
double stretch_of(const Affine& place) {
    const glm::dmat3& m = place.linear;
    return std::max({glm::length(m[0]), glm::length(m[1]), glm::length(m[2])});
}

/// Distance in metres, in the parent's space, between two values of a joint, at its probes.
double difference(const Local& a, const Local& b, TrackPath path, double reach) {
    if (path == TrackPath::translation) return glm::length(a.translation - b.translation);
    if (path == TrackPath::scale) return glm::length(a.scale - b.scale) * reach;
    const double sign = glm::dot(a.rotation, b.rotation) < 0.0 ? -1.0 : 1.0;
    const glm::dquat off = a.rotation - b.rotation * sign;
    return 2.0 * std::sqrt(glm::dot(off, off)) * reach;
}

/// Per joint, a bound on the distance of the farthest probe that it moves, at rest and in its own space.
std::vector<double> reaches_of(const Scene& scene, const std::vector<std::vector<glm::dvec3>>& probes) {
    std::vector<double> reaches(scene.joints.size(), 0.0);
    for (std::size_t j = reaches.size(); j-- > 0;) {
        for (const glm::dvec3& probe : probes[j]) reaches[j] = std::max(reaches[j], glm::length(probe));
        const Joint& joint = scene.joints[j];
        if (joint.parent == kNone) continue;
        const Affine local = to_affine(local_of(joint.rest), joint.rest.shear);
        double& above = reaches[joint.parent];
        above = std::max(above, glm::length(local.origin) + stretch_of(local) * reaches[j]);
    }
    return reaches;
}

/// Interpolates between two values; the chord is near enough to the arc for this purpose.
Local between(const Local& a, const Local& b, double u) {
    Local found = a;
    found.translation = a.translation * (1.0 - u) + b.translation * u;
    found.scale = a.scale * (1.0 - u) + b.scale * u;
    const double sign = glm::dot(a.rotation, b.rotation) < 0.0 ? -1.0 : 1.0;
    found.rotation = glm::normalize(a.rotation * (1.0 - u) + b.rotation * (sign * u));
    return found;
}

/// Number of steps in a grid, as if all had the usual length.
std::uint32_t even_steps(const Grid& grid) {
    if (grid.rate != 0.0f || grid.frames < 2) return grid.frames - 1;
    std::vector<float> steps;
    for (std::size_t k = 1; k < grid.times.size(); ++k) steps.push_back(grid.times[k] - grid.times[k - 1]);
    const auto usual = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), usual, steps.end());
    const double count = (double{grid.times.back()} - grid.times.front()) / *usual;
    return static_cast<std::uint32_t>(std::nearbyint(std::min(count, grid.frames - 1.0)));
}

double error_of(const Track& track, const Local& rest, const Grid& from, const Grid& to, double reach, double most) {
    std::vector<Local> kept(to.frames, rest);
    std::vector<double> value;
    for (std::uint32_t f = 0; f < to.frames; ++f) {
        evaluate_track(track, snapped(track, to.time_of(f), to.snap()), value);
        set_property(track.path, value, kept[f]);
    }
    double worst = 0.0;
    for (std::uint32_t f = 0; f < from.frames && worst <= most; ++f) {
        Local exact = rest;
        evaluate_track(track, snapped(track, from.time_of(f), from.snap()), value);
        set_property(track.path, value, exact);
        const double at = std::max(0.0, (from.time_of(f) - to.start) * to.rate);
        const auto left = static_cast<std::uint32_t>(std::min(at, to.frames - 2.0));
        const Local found = between(kept[left], kept[left + 1], std::min(at - left, 1.0));
        worst = std::max(worst, difference(exact, found, track.path, reach));
    }
    return worst;
}

}  // namespace

std::vector<bool> find_still(const Scene& scene, const Clip& clip, const std::vector<std::vector<glm::dvec3>>& probes,
                             double max_error) {
    constexpr double kPart = 0.2;  // of the bound, for all joints of a chain together
    std::vector<Local> rest;
    std::vector<std::size_t> depth;
    for (const Joint& joint : scene.joints) {
        rest.push_back(local_of(joint.rest));
        depth.push_back(joint.parent == kNone ? 1 : depth[joint.parent] + 1);
    }
    std::vector<Affine> places(rest.size());
    place_joints(scene.joints, rest, places);
    const std::vector<double> reaches = reaches_of(scene, probes);
    const double deepest = depth.empty() ? 1.0 : static_cast<double>(*std::max_element(depth.begin(), depth.end()));
    std::vector<bool> still(clip.tracks.size());
    for (std::size_t number = 0; number < still.size(); ++number) {
        const Track& track = clip.tracks[number];
        if (track.path == TrackPath::weights || track.interpolation != Interpolation::step) continue;
        const std::uint32_t parent = scene.joints[track.target].parent;
        const double stretch = parent == kNone ? 1.0 : stretch_of(places[parent]);
        const auto at = [&](std::size_t key) {
            Local local = rest[track.target];
            const auto from = track.values.begin() + static_cast<std::ptrdiff_t>(key * track.components);
            set_property(track.path, {from, from + track.components}, local);
            return local;
        };
        const Local first = at(0);
        bool is_still = true;
        for (std::size_t key = 1; key < track.times.size() && is_still; ++key) {
            const double moved = difference(first, at(key), track.path, reaches[track.target]) * stretch;
            is_still = moved <= kPart * max_error / deepest;
        }
        still[number] = is_still;
    }
    return still;
}

double grid_error(const Scene& scene, const Clip& clip, const GridTracks& tracks, const Grid& even,
                  const std::vector<std::vector<glm::dvec3>>& probes, double most) {
    double worst = 0.0;
    for (const std::uint32_t number : tracks.tracks) {
        const Track& track = clip.tracks[number];
        double reach = 0.0;
        for (const glm::dvec3& probe : probes[track.target]) reach = std::max(reach, glm::length(probe));
        const Local rest = local_of(scene.joints[track.target].rest);
        worst = std::max(worst, error_of(track, rest, tracks.grid, even, reach, most));
        if (worst > most) break;
    }
    return worst;
}

std::optional<ThinGrid> thin_grid(const Scene& scene, const Clip& clip, const GridTracks& tracks, std::uint32_t fewer,
                                  const std::vector<std::vector<glm::dvec3>>& probes, double most) {
    const Grid& old = tracks.grid;
    const std::uint32_t frames = (even_steps(old) + fewer / 2) / fewer + 1;
    if (frames < kFewest) return std::nullopt;
    ThinGrid thin{{old.start, 0.0f, frames, {}}, 0.0};
    thin.grid.rate = static_cast<float>((frames - 1) / (old.time_of(old.frames - 1) - double{old.start}));
    if (!std::isfinite(thin.grid.rate)) return std::nullopt;
    thin.error = grid_error(scene, clip, tracks, thin.grid, probes, most);
    return thin.error <= most ? std::optional(thin) : std::nullopt;
}

}  // namespace bendy::converter
