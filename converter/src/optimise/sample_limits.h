#pragma once

#include <bendy/converter/scene.h>

#include <cstddef>
#include <vector>

namespace bendy::converter {

/// Rate at which clips are measured between their keys.
inline constexpr double kSamplesPerSecond = 240.0;

/// Work limits for a clip. A file with two keys can claim that a clip lasts a year, so no work may be proportional to
/// its duration alone: it is bounded by the amount of data in the file. The bounds are far above what real clips need.
struct ClipLimits {
    std::size_t samples = 0;  ///< evenly spaced times, besides the keys, at which the whole character is posed
    std::size_t frames = 0;   ///< frames that may be held for all joints at once
};

struct WorkLimits {
    std::vector<ClipLimits> clips;
    /// False: the keys alone need more poses of more joints and vertices than the file's size allows.
    bool can_be_measured = true;
    std::size_t pose_bytes = 0;  ///< memory limit for cached poses of one clip
};

/// Limits for measuring a scene. The unit is one joint, or one vertex that targets may move, in one pose. The samples
/// of all clips may have a million units, plus 128 for each number of the clips and each byte of the meshes. If
/// kSamplesPerSecond stays below that, every clip is sampled at that rate.
WorkLimits find_limits(const Scene& scene);

}  // namespace bendy::converter
