#pragma once

#include <bendy/format/public.h>
#include <bendy/runtime/playback.h>
#include <bendy/runtime/pose.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

// Root motion: what a clip's root joint does on the ground is taken out of the pose and moves the character instead,
// through walls and slopes as the game has them. In doubles, since it adds up over hours.
namespace BENDY_PUBLIC bendy {

/// A turn, then a shift.
struct RootMotion {
    glm::dvec3 translation{0.0};              ///< metres
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};  ///< unit

    [[nodiscard]] glm::dmat4 matrix() const;
};

/// `motion` in the axes of `before`, after it: character = compose(character, motion) each frame.
[[nodiscard]] RootMotion compose(const RootMotion& before, const RootMotion& motion);
/// What undoes it.
[[nodiscard]] RootMotion inverse(const RootMotion& motion);
/// A share of the way from one to the other, 0 to 1, the short way round: for crossfades.
[[nodiscard]] RootMotion blend(const RootMotion& motion, const RootMotion& other, double weight);
/// `motion` so many times over. Exact to about 1e-15 of what it moves for each of the `times` at worst.
[[nodiscard]] RootMotion repeat(const RootMotion& motion, std::uint64_t times);

enum class RootTurn : std::uint8_t {
    none,
    yaw,  ///< about the model's y axis, which is up
    all,
};

/// What of the root's movement is the character's. The rest stays in the pose: by default bobbing and leaning do.
struct RootAxes {
    bool x = true, y = false, z = true;  ///< translation along the model's axes
    RootTurn turn = RootTurn::yaw;
};

/// The joint that carries a character over the ground: a root joint, or hips. Reads clips of its model only; any
/// number of threads may share one. Made once; nothing else allocates.
class RootPath {
public:
    /// \param joint  of the model; one that it does not have never moves
    RootPath(const Model& model, std::uint32_t joint, const RootAxes& axes = {});

    /// From where the rest pose stands to where the clip has the root at that time, in model space: the position along
    /// the chosen axes, and the chosen turn. Yaw is the twist of the turn since rest; a root upside down has none.
    [[nodiscard]] RootMotion at(const Clip& clip, double seconds) const;
    /// The movement from one time to another, in the axes that the character has at `from`.
    [[nodiscard]] RootMotion between(const Clip& clip, double from, double to) const;
    /// The movement of a whole walk of a Playback: over ends it goes on as if the next pass began where the last one
    /// ended. As quick for thousands of passes as for one.
    [[nodiscard]] RootMotion over(const Clip& clip, const PlayedInterval& played) const;

    /// Takes the movement out of a pose and gives it back: along the chosen axes the root then stands as at rest, so
    /// that clips fit one another when they are mixed. What hangs below the root comes along; joints above it stay. If
    /// one of those is scaled unevenly, the turn is not quite taken out; if one is flat, nothing is.
    RootMotion extract(Pose& pose) const;

private:
    [[nodiscard]] RootMotion motion_of(const glm::dmat4& root) const;
    [[nodiscard]] RootMotion along(const Clip& clip, const TimeSpan& span) const;

    Model model_;
    RootAxes axes_;
    std::vector<std::uint32_t> path_;  // from the model's root down to the joint; empty: none
    glm::dvec3 chosen_{0.0};           // 1 for axes that are taken
    glm::dvec3 rest_position_{0.0};
    glm::dquat rest_rotation_{1.0, 0.0, 0.0, 0.0};
};

}  // namespace bendy
