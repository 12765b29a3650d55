#pragma once

#include "humanoid.h"
#include "rest_frames.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <string>
#include <vector>

namespace bendy::converter {

/// Which way a character looks and stands, in model space: unit vectors at right angles, left x up = forward.
struct Stance {
    glm::dvec3 left{1.0, 0.0, 0.0};
    glm::dvec3 up{0.0, 1.0, 0.0};
    glm::dvec3 forward{0.0, 0.0, 1.0};
};

/// The chains of a humanoid: LeftArm, RightArm, LeftLeg, RightLeg (two-bone), Spine (CCD) and Head (aim), those whose
/// bones are there. Limbs bend to where they are bent at rest, by more than a degree; a straight one bends knees
/// forward and elbows backward. Joints between the bones, as twist segments, get weight 0. The head's tip lies straight
/// ahead of the neck and has the character's axes: Z forward, Y up. A limb whose end is not below its start, or has no
/// such bone, is named in `report` and left out.
/// \param flags  of the chains
/// \param where  the JSON path to name, may be empty
std::vector<Chain> make_limb_chains(const Scene& scene, const RestFrames& rest, const Humanoid& humanoid,
                                    const Stance& stance, std::uint8_t flags, const std::string& where, Report& report);

/// A chain without pole and weights.
Chain make_chain(const char* name, std::uint32_t start, std::uint32_t effector, Solver solver, std::uint8_t flags);

/// Joints from `effector` up to `start`, both included, the start first; empty if the one is not at or below the other.
std::vector<std::uint32_t> path_of(const Scene& scene, std::uint32_t start, std::uint32_t effector);

/// Where the middle joint lies beside the line from start to end, unit; nothing if the limb is straight within a
/// degree.
std::optional<glm::dvec3> bend_of(const RestFrames& rest, std::uint32_t start, std::uint32_t middle, glm::dvec3 end);

/// Adds the chains whose names are not taken; which they were.
std::vector<std::size_t> add_new_chains(Scene& scene, std::vector<Chain> chains);

}  // namespace bendy::converter
