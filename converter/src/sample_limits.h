#pragma once

#include <bendy/converter/scene.h>

#include <cstddef>
#include <vector>

namespace bendy::converter {

/// How often a second clips are measured, beside their keys.
inline constexpr double kSamplesPerSecond = 240.0;

/// How much may be done for a clip. A file of two keys can say that a clip lasts a year, so no work follows its seconds
/// alone: it is bounded by the numbers that the file has. The bounds are far above what clips as people make them need.
struct ClipLimits {
    std::size_t samples = 0;  ///< evenly spaced times at which the whole character is posed, beside the keys
    std::size_t frames = 0;   ///< that are held for all joints at once
};

struct WorkLimits {
    std::vector<ClipLimits> clips;
    /// False: the keys alone ask for more poses of more joints and vertices than the file's size allows.
    bool can_be_measured = true;
    std::size_t pose_bytes = 0;  ///< that may be kept of the poses of one clip
};

/// For measuring a scene. What is counted is a joint, or a vertex that targets may move, in one pose. The samples of
/// all clips may have a million of them and 128 for each number of the clips and each byte of the meshes. Where they
/// stay below that at kSamplesPerSecond, no clip has fewer.
WorkLimits find_limits(const Scene& scene);

}  // namespace bendy::converter
