#pragma once

#include "space.h"

#include <bendy/converter/scene.h>
#include <bendy/format/packed_clip.h>

#include <cstdint>
#include <vector>

namespace bendy::converter {

enum class Probes : std::uint8_t {
    skin_and_shell,  ///< the skin's extreme points and the shell
    shell,           ///< the shell alone: for comparison with what others measure
};

/// Where errors are measured: points in each joint's space. The skin moves no farther than the hull of the points that
/// a joint influences; the shell, three points at 3 % of the character's height from a joint along its axes, stands for
/// what hangs on it.
std::vector<std::vector<glm::dvec3>> find_probes(const Scene& scene, Probes kind);

/// The farthest that a probe is from where the source has it.
struct WorstError {
    double metres = 0.0;  ///< in model space
    std::uint32_t joint = kNone;
    double seconds = 0.0;  ///< on the clip's time line
};

/// Plays a packed clip against its source, 240 times a second and at each of the source's key times, the source
/// interpolated as glTF says.
/// \param source       with all tracks
/// \param is_replaced  per track: the packed clip has it, or leaves the property at rest
/// \param packed       as read from the bytes that are written
/// \param enough       stops at the first error above this
WorstError measure_packed(const Scene& scene, const Clip& source, const std::vector<bool>& is_replaced,
                          const PackedView& packed, const std::vector<std::vector<glm::dvec3>>& probes, double enough);

}  // namespace bendy::converter
