#pragma once

#include <bendy/converter/scene.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace bendy::converter {

/// Frame times as PACK stores them: evenly spaced, or a list.
struct Grid {
    float start = 0.0f;  ///< seconds
    float rate = 1.0f;   ///< frames per second; 0: listed in `times`
    std::uint32_t frames = 1;
    std::vector<float> times{};

    [[nodiscard]] double time_of(std::uint32_t frame) const {
        return rate != 0.0f ? double{start} + frame / double{rate} : double{times[frame]};
    }
    /// Seconds: a key nearer to a frame than this is snapped to it.
    [[nodiscard]] double snap() const;
};

/// More than any clip of a packable file has.
inline constexpr std::size_t kMostFrames = 16'000'000;

/// The time of the track's last key within `snap` seconds of the given time; or that time itself.
double snapped(const Track& track, double seconds, double snap);

/// The coarsest grid that holds the keys of as many tracks as possible, and the numbers of those tracks: linear ones of
/// joints. If no even grid holds them all, the list of all key times, if there are few. Constant tracks need no grid.
/// Nothing if there is nothing to pack.
/// \param most_frames  maximum number of frames of a grid
/// \param still        per track: it counts as constant although its keys differ, see find_still; may be empty
struct GridTracks {
    Grid grid;
    std::vector<std::uint32_t> tracks;
};
std::optional<GridTracks> find_grid(const Clip& clip, std::size_t most_frames = kMostFrames,
                                    const std::vector<bool>& still = {});

/// Which step tracks are constant within a small part of the bound: exporters write constants as two such keys.
/// \param probes     per joint, see find_probes
/// \param max_error  metres in model space
std::vector<bool> find_still(const Scene& scene, const Clip& clip, const std::vector<std::vector<glm::dvec3>>& probes,
                             double max_error);

/// Keys farther from a frame than this, in frames, are off the grid.
inline constexpr double kGridTolerance = 0.01;

/// A grid of the same span with fewer frames.
struct ThinGrid {
    Grid grid;
    /// Metres: the worst single joint's error from interpolating between the frames, at its own probes and at the old
    /// frames. Errors of its ancestors are not included.
    double error = 0.0;
};

/// Keeps about one frame in `fewer`, evenly spaced: frames need not lie on keys. Nothing if the old grid is uneven, few
/// frames would be left, or the error is more than `most` metres.
/// \param probes  per joint, see find_probes
std::optional<ThinGrid> thin_grid(const Scene& scene, const Clip& clip, const GridTracks& tracks, std::uint32_t fewer,
                                  const std::vector<std::vector<glm::dvec3>>& probes, double most);

}  // namespace bendy::converter
