#pragma once

#include <bendy/format/records.h>
#include <bendy/runtime/pose.h>
#include <bendy/runtime/retarget.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace bendy::motion {

/// A bone that source and target both have: from a joint to the next one of the body.
struct SharedBone {
    struct Ends {
        std::uint32_t from = kNone, to = kNone;
    };
    Ends source, target;
    double far = 0.0;  ///< radians: more than bodies of different makers differ by
};

/// Why a bone points elsewhere than the source's.
enum class Cause : std::uint8_t {
    rests,   ///< it does so without limits and ground, too: a standing pose is wrong, or the bodies are unlike
    limits,  ///< limits of the target
    ground,  ///< a foot that is held on the ground
};
inline constexpr std::size_t kCauses = 3;

/// Compares the directions of bones in poses of the target with those in the source's. Made once for all clips.
class BoneComparison {
public:
    BoneComparison(const Retarget& retarget, const RetargetOptions& options);

    /// The trunk, the neck, collarbones, arms, legs and feet of humans, and the upper bones of animals' legs, as far as
    /// both bodies have them.
    [[nodiscard]] const std::vector<SharedBone>& bones() const { return bones_; }
    /// Returns the angle between a bone's directions in two poses, radians; 0 if it has no length.
    [[nodiscard]] double angle(const SharedBone& bone, Pose& source, Pose& target) const;
    /// Finds out why a bone is far off, by retargeting the source's pose again without the ground and without limits.
    /// \param target  a pose to work with
    Cause find_cause(const SharedBone& bone, Pose& source, Pose& target);

private:
    bool is_far(const SharedBone& bone, Pose& source, Pose& target, bool obeys_constraints);

    Retarget retarget_;
    RetargetOptions options_;
    std::vector<SharedBone> bones_;
    std::array<std::optional<Retarget>, 2> without_ground_;  ///< beyond limits, within limits; made when needed
};

}  // namespace bendy::motion
