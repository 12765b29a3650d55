#pragma once

#include "scene/space.h"

#include <bendy/converter/scene.h>
#include <bendy/format/packed_clip.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace bendy::converter {

enum class Probes : std::uint8_t {
    skin_and_shell,  ///< the skin's extreme points and the shell
    shell,           ///< the shell alone: for comparison with other tools
};

/// The points, in each joint's space, where errors are measured. The skin moves no farther than the hull of the points
/// that a joint influences; the shell, three points at 3 % of the character's height from a joint along its axes,
/// stands for objects attached to it.
std::vector<std::vector<glm::dvec3>> find_probes(const Scene& scene, Probes kind);

/// The largest distance of a probe from its place in the source.
struct WorstError {
    double metres = 0.0;  ///< in model space
    std::uint32_t joint = kNone;
    double seconds = 0.0;  ///< on the clip's time line
};

/// A clip sampled for measurement: its joints 240 times a second and at each key time, interpolated as glTF defines.
class SourceMotion {
public:
    /// Refers to both.
    /// \param most_samples  between the keys, see ClipLimits
    /// \param most_bytes    memory limit for cached poses
    SourceMotion(const Scene& scene, const Clip& clip, std::size_t most_samples, std::size_t most_bytes);

    [[nodiscard]] const Scene& scene() const { return scene_; }
    [[nodiscard]] const Clip& clip() const { return clip_; }
    [[nodiscard]] const std::vector<Local>& rest() const { return rest_; }
    /// Seconds on the clip's time line, ascending.
    [[nodiscard]] std::span<const float> times() const { return times_; }
    /// The joint-to-model transforms of all joints at times()[k]; valid until the next call.
    std::span<const Affine> pose(std::size_t k);

private:
    void evaluate_at(float seconds, std::span<Affine> out);

    const Scene& scene_;
    const Clip& clip_;
    std::vector<float> times_;
    std::vector<Local> rest_, locals_;
    std::vector<double> value_;
    std::vector<Affine> poses_;  // of all times if they fit, else of one
    bool has_all_ = false;
};

/// Compares a packed clip with its source at all of the source's times.
/// \param is_replaced  per track: the packed clip has it, or leaves the property at rest
/// \param packed       as read back from the written bytes
/// \param enough       stops at the first error above this
WorstError measure_packed(SourceMotion& source, const std::vector<bool>& is_replaced, const PackedView& packed,
                          const std::vector<std::vector<glm::dvec3>>& probes, double enough);

}  // namespace bendy::converter
