#pragma once

#include <bendy/converter/scene.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace bendy::converter {

/// The times of frames, as PACK stores them: evenly spaced, or a list.
struct Grid {
    float start = 0.0f;  ///< seconds
    float rate = 1.0f;   ///< frames per second; 0: `times` has them
    std::uint32_t frames = 1;
    std::vector<float> times{};

    [[nodiscard]] double time_of(std::uint32_t frame) const {
        return rate != 0.0f ? double{start} + frame / double{rate} : double{times[frame]};
    }
    /// Seconds: keys nearer to a frame than this are the frame's.
    [[nodiscard]] double snap() const;
};

/// More than any clip of a file that can be packed has.
inline constexpr std::size_t kMostFrames = 16'000'000;

/// The time of the track's last key that is not farther than `snap` seconds from a time; or that time itself.
double snapped(const Track& track, double seconds, double snap);

/// The coarsest grid that holds the keys of as many tracks as possible, and the numbers of those tracks: linear ones of
/// joints. If no even grid holds them all, all the times at which there are keys, where those are few. Tracks that
/// never change need no grid. Nothing if there is nothing to pack. \param most_frames  that a grid may have
struct GridTracks {
    Grid grid;
    std::vector<std::uint32_t> tracks;
};
std::optional<GridTracks> find_grid(const Clip& clip, std::size_t most_frames = kMostFrames);

/// Keys farther from a frame than this, in frames, are not on the grid.
inline constexpr double kGridTolerance = 0.01;

/// A grid of the same span with fewer frames.
struct ThinGrid {
    Grid grid;
    /// Metres: what lines between its frames cost the worst joint alone, at its own probes and at the old frames. What
    /// the joints above cost comes on top.
    double error = 0.0;
};

/// About one frame of `fewer`, evenly spaced: frames need not lie on keys. Nothing if the old grid is uneven, few
/// frames would be left, or the error is more than `most` metres. \param probes  per joint, see find_probes
std::optional<ThinGrid> thin_grid(const Scene& scene, const Clip& clip, const GridTracks& tracks, std::uint32_t fewer,
                                  const std::vector<std::vector<glm::dvec3>>& probes, double most);

}  // namespace bendy::converter
