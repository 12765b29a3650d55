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

/// A grid, and the numbers of the tracks that it holds: linear ones of joints, and constant ones, which need no grid.
struct GridTracks {
    Grid grid;
    std::vector<std::uint32_t> tracks;
};

/// Returns the grids to try, best first; none if there is nothing to pack. The first is the coarsest even grid that
/// holds the keys of all tracks. The second is the list of all key times, if they are few: it is exact where keys lie
/// a little beside the even grid. The list is the only one if the even grid has far more frames, or misses keys. If
/// the times are too many for a list, the only one is the even grid that holds the keys of most tracks.
/// \param most_frames  maximum number of frames of a grid
/// \param still        per track: it counts as constant although its keys differ, see find_still; may be empty
std::vector<GridTracks> find_grids(const Clip& clip, std::size_t most_frames = kMostFrames,
                                   const std::vector<bool>& still = {});

/// Which step tracks are constant within a small part of the bound: exporters write constants as two such keys.
/// \param probes     per joint, see find_probes
/// \param max_error  metres in model space
std::vector<bool> find_still(const Scene& scene, const Clip& clip, const std::vector<std::vector<glm::dvec3>>& probes,
                             double max_error);

/// Keys farther from a frame than this, in frames, are off the grid.
inline constexpr double kGridTolerance = 0.01;

/// Returns the worst single joint's error, in metres, from interpolating between the frames of an even grid: at its own
/// probes and at the frames of the tracks' grid, without the errors of its ancestors. It stops at an error of more than
/// `most`.
/// \param probes  per joint, see find_probes
double grid_error(const Scene& scene, const Clip& clip, const GridTracks& tracks, const Grid& even,
                  const std::vector<std::vector<glm::dvec3>>& probes, double most);

/// A grid of the same span with fewer frames.
struct ThinGrid {
    Grid grid;
    double error = 0.0;  ///< see grid_error
};

/// An even grid with about one frame in `fewer`, which need not lie on keys. Nothing if few frames would be left, or
/// the error is more than `most` metres.
std::optional<ThinGrid> thin_grid(const Scene& scene, const Clip& clip, const GridTracks& tracks, std::uint32_t fewer,
                                  const std::vector<std::vector<glm::dvec3>>& probes, double most);

}  // namespace bendy::converter
