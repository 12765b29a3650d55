#pragma once

#include "humanoid.h"
#include "scene/rest_frames.h"

#include <bendy/converter/report.h>
#include <bendy/converter/scene.h>

#include <string>
#include <vector>

namespace bendy::converter {

/// A character's orientation in model space: orthonormal vectors, left x up = forward.
struct Stance {
    glm::dvec3 left{1.0, 0.0, 0.0};
    glm::dvec3 up{0.0, 1.0, 0.0};
    glm::dvec3 forward{0.0, 0.0, 1.0};
};

/// The chains of a humanoid whose bones exist: LeftArm, RightArm, LeftLeg, RightLeg (two-bone), Spine (CCD) and Head
/// (aim). Limbs keep the direction of their bend at rest if that is more than a degree; a straight limb bends knees
/// forward and elbows backward. Joints between the bones, such as twist segments, get weight 0. The head's tip lies
/// straight ahead of the neck and has the character's axes: Z forward, Y up. A limb that has no end joint, or one that
/// is not below its start, is named in `report` and left out.
/// \param flags  of the chains
/// \param where  the JSON path for warnings, may be empty
std::vector<Chain> make_limb_chains(const Scene& scene, const RestFrames& rest, const Humanoid& humanoid,
                                    const Stance& stance, std::uint8_t flags, const std::string& where, Report& report);

/// A chain without a pole and weights.
Chain make_chain(std::string name, std::uint32_t start, std::uint32_t effector, Solver solver, std::uint8_t flags);

/// Joints from `start` down to `effector`, both included; empty if `effector` is neither `start` nor below it.
std::vector<std::uint32_t> path_of(const Scene& scene, std::uint32_t start, std::uint32_t effector);

/// The unit direction of the middle joint's offset from the line from start to end; nothing if the limb is straight
/// within a degree.
std::optional<glm::dvec3> bend_of(const RestFrames& rest, std::uint32_t start, std::uint32_t middle, glm::dvec3 end);

/// Adds the chains whose names are not taken; returns their indices.
std::vector<std::size_t> add_new_chains(Scene& scene, std::vector<Chain> chains);

}  // namespace bendy::converter
