#pragma once

#include "space.h"

#include <bendy/converter/scene.h>
#include <bendy/format/packed_clip.h>

#include <cstddef>
#include <cstdint>
#include <span>
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

/// A clip as it is measured: its joints 240 times a second and at each of its key times, interpolated as glTF says.
class SourceMotion {
public:
    /// Refers to both. \param most_samples  between the keys, see ClipLimits \param most_bytes  of poses that are kept
    SourceMotion(const Scene& scene, const Clip& clip, std::size_t most_samples, std::size_t most_bytes);

    [[nodiscard]] const Scene& scene() const { return scene_; }
    [[nodiscard]] const Clip& clip() const { return clip_; }
    [[nodiscard]] const std::vector<Local>& rest() const { return rest_; }
    /// Seconds on the clip's time line, ascending.
    [[nodiscard]] std::span<const float> times() const { return times_; }
    /// Joint to model space of all joints at times()[k], until the next call.
    std::span<const Affine> pose(std::size_t k);

private:
    void evaluate_at(float seconds, std::span<Affine> out);

    const Scene& scene_;
    const Clip& clip_;
    std::vector<float> times_;
    std::vector<Local> rest_, locals_;
    std::vector<double> value_;
    std::vector<Affine> poses_;  // of all times where there are few, else of one
    bool has_all_ = false;
};

/// Plays a packed clip against its source, at all times of that.
/// \param is_replaced  per track: the packed clip has it, or leaves the property at rest
/// \param packed       as read from the bytes that are written
/// \param enough       stops at the first error above this
WorstError measure_packed(SourceMotion& source, const std::vector<bool>& is_replaced, const PackedView& packed,
                          const std::vector<std::vector<glm::dvec3>>& probes, double enough);

}  // namespace bendy::converter
