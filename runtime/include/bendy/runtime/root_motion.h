#pragma once

#include <bendy/format/public.h>
#include <bendy/format/result.h>
#include <bendy/runtime/call_error.h>
#include <bendy/runtime/playback.h>
#include <bendy/runtime/pose.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

// Root motion: the ground movement of a clip's root joint is taken out of the pose and moves the character instead, so
// that the game can apply collisions and slopes. In double precision, since it accumulates over hours.
namespace BENDY_PUBLIC bendy {

/// A rotation followed by a translation.
struct RootMotion {
    glm::dvec3 translation{0.0};              ///< metres
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  ///< unit

    [[nodiscard]] glm::dmat4 matrix() const;
};

/// Applies `motion`, given in the axes of `before`, after `before`. Each frame: character = compose(character, motion).
[[nodiscard]] RootMotion compose(const RootMotion& before, const RootMotion& motion);
/// Returns the inverse.
[[nodiscard]] RootMotion inverse(const RootMotion& motion);
/// Interpolates between two motions, weight 0 to 1, along the shorter arc: for crossfades.
[[nodiscard]] RootMotion blend(const RootMotion& motion, const RootMotion& other, double weight);
/// Returns `motion` applied `times` times. The error is at most about 1e-15 of the movement for each of the `times`.
[[nodiscard]] RootMotion repeat(const RootMotion& motion, std::uint64_t times);

enum class RootTurn : std::uint8_t {
    none,
    yaw,  ///< rotation about the model's y axis, which is up
    all,
};

/// Which parts of the root's movement move the character. The rest, by default bobbing and leaning, stays in the pose.
struct RootAxes {
    bool x = true, y = false, z = true;  ///< translation along the model's axes
    RootTurn turn = RootTurn::yaw;
};

/// The root motion of the joint that carries a character over the ground: a root joint, or the hips. Any number of
/// threads may share one. Allocates only when it is made. Error of all calls: other_model, for a clip or a pose of
/// another model.
class RootPath {
public:
    /// \param joint  a joint of the model; without such a joint, the motion is empty
    RootPath(const Model& model, std::uint32_t joint, const RootAxes& axes = {});

    /// Returns the motion from the root's rest pose to its position in the clip at that time, in model space: the
    /// translation along the chosen axes, and the chosen rotation. Yaw is the twist of the rotation relative to rest;
    /// it is zero for a root that is upside down.
    [[nodiscard]] Result<RootMotion, CallError> at(const Clip& clip, double seconds) const;
    /// Returns the motion from one time to another, in the axes that the character has at `from`.
    [[nodiscard]] Result<RootMotion, CallError> between(const Clip& clip, double from, double to) const;
    /// Returns the motion over an interval of a Playback: across the ends it continues as if the next pass began where
    /// the last one ended. Takes the same time for thousands of passes as for one.
    [[nodiscard]] Result<RootMotion, CallError> over(const Clip& clip, const PlayedInterval& played) const;

    /// Takes the motion out of a pose and returns it: along the chosen axes the root is then at rest, so that clips
    /// line up when they are mixed. The root's descendants move with it; joints above it stay. If one of those is
    /// scaled unevenly, the rotation is not removed completely; if one is flat, nothing is removed.
    Result<RootMotion, CallError> extract(Pose& pose) const;

private:
    [[nodiscard]] RootMotion motion_of(const glm::dmat4& root) const;
    /// \param clip  of the model, as in the calls above once it is checked
    [[nodiscard]] RootMotion motion_at(const Clip& clip, double seconds) const;
    [[nodiscard]] RootMotion motion_between(const Clip& clip, double from, double to) const;
    [[nodiscard]] RootMotion along(const Clip& clip, const TimeSpan& span) const;

    Model model_;
    RootAxes axes_;
    std::vector<std::uint32_t> path_;  // from the model's root down to the joint; empty: none
    glm::dvec3 chosen_{0.0};           // 1 for the axes that are taken out, otherwise 0
    glm::dvec3 rest_position_{0.0};
    glm::dquat rest_rotation_{1.0, 0.0, 0.0, 0.0};
};

}  // namespace bendy
