#pragma once

#include <bendy/converter/scene.h>

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bendy::converter {

/// The largest distance between the same point in two scenes.
struct MeasuredError {
    double metres = 0.0;           ///< infinite if the scenes cannot be compared, or a number is not finite
    std::uint32_t mesh = kNone;    ///< kNone: nothing differs, or the worst is a joint
    std::uint32_t vertex = kNone;  ///< of the exact scene's mesh
    std::uint32_t joint = kNone;   ///< set if the worst error is that of a joint that moves no vertex
    std::uint32_t clip = kNone;    ///< kNone: the rest pose
    double seconds = 0.0;          ///< on the clip's time line
};

/// For each mesh of the exact scene, the number of each vertex in the decoded one; kNone: it has none, and is not
/// compared. Without maps, or with an empty one, the numbers are the same.
using VertexMaps = std::span<const std::vector<std::uint32_t>>;

struct MeasureOptions {
    VertexMaps vertex_maps{};
    std::function<void(double)> progress{};  ///< called with the fraction done, 0 to 1; may be empty
    std::size_t threads = 1;                 ///< maximum; the result does not depend on it
    double known = 0.0;                      ///< metres, at most the limit: smaller errors need not be found
    double limit = std::numeric_limits<double>::infinity();  ///< metres: for measure_clips
    /// Per joint, in its space: points beside the skin that count if they are farther off than the limit.
    std::span<const std::vector<glm::dvec3>> shell{};
    bool only_keys = false;  ///< a rough measurement: nothing between the keys
};

/// Compares every vertex, displaced and skinned, and every joint that moves none, in the rest pose and in every clip:
/// 240 times a second, and at all key times of both scenes. Clips longer than 7 minutes get as many samples as one of
/// that length. A vertex is skipped only if a bound on its error (docs/decisions/0013) shows that it cannot be the
/// worst.
/// \param decoded  joints, meshes and clips in the numbering of the exact scene
MeasuredError measure_error(const Scene& exact, const Scene& decoded, const MeasureOptions& options = {});

/// As above, for some clips by number: the error of each and, last, that of the rest pose. Errors above the limit are
/// the clip's worst. So is the largest of those that are at most the limit; the others may be less than the worst, or
/// 0.
std::vector<MeasuredError> measure_clips(const Scene& exact, const Scene& decoded, std::span<const std::uint32_t> clips,
                                         const MeasureOptions& options = {});

/// `"Hips"`, or `#3` if it has no name.
std::string quoted_name(std::string_view name, std::uint32_t number);

/// The place of an error in words: `mesh "Body", vertex 3, clip "Walk" at 0.250 s`; empty if there is none.
std::string place_of(const Scene& scene, const MeasuredError& error);

}  // namespace bendy::converter
