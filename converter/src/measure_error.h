#pragma once

#include <bendy/converter/scene.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::converter {

/// The largest distance between where two scenes put the same thing.
struct MeasuredError {
    double metres = 0.0;           ///< infinite where the scenes cannot be compared, or a number is not finite
    std::uint32_t mesh = kNone;    ///< kNone: nothing differs, or the worst is a joint
    std::uint32_t vertex = kNone;  ///< of the exact scene's mesh
    std::uint32_t joint = kNone;   ///< set where the worst is the place of a joint that moves no vertex
    std::uint32_t clip = kNone;    ///< kNone: the rest pose
    double seconds = 0.0;          ///< on the clip's time line
};

/// For each mesh of the exact scene where its vertices are in the decoded one; kNone: nowhere, not compared. No maps,
/// or an empty one: the same places.
using VertexMaps = std::span<const std::vector<std::uint32_t>>;

struct MeasureOptions {
    VertexMaps vertex_maps{};
    std::function<void(double)> progress{};  ///< is told the part that is done, 0 to 1; may be empty
    std::size_t threads = 1;                 ///< at most; the result does not depend on it
};

/// Compares every vertex, displaced and skinned, and every joint that moves none, in the rest pose and in every clip:
/// at 240 times a second, and at all key times of both scenes. Clips longer than 7 minutes are sampled as often as
/// ones of that length. Nothing is left out for speed: a vertex is passed over only where a bound on its displacement
/// (docs/decisions/0013) shows that it cannot be the worst.
/// \param decoded  joints, meshes and clips as the exact scene numbers them
MeasuredError measure_error(const Scene& exact, const Scene& decoded, const MeasureOptions& options = {});

/// The same of some clips, by their numbers: the worst error of each, and as a last one that of the rest pose.
std::vector<MeasuredError> measure_clips(const Scene& exact, const Scene& decoded, std::span<const std::uint32_t> clips,
                                         const MeasureOptions& options = {});

/// `"Hips"`, or `#3` of what has no name.
std::string quoted_name(std::string_view name, std::uint32_t number);

/// Where an error was met, in words: `mesh "Body", vertex 3, clip "Walk" at 0.250 s`; empty if nowhere.
std::string place_of(const Scene& scene, const MeasuredError& error);

}  // namespace bendy::converter
