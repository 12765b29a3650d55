#pragma once

#include "animal.h"
#include "clip_rotations.h"
#include "find_humanoid.h"
#include "scene/rest_frames.h"

#include <bendy/converter/scene.h>

#include <optional>
#include <vector>

namespace bendy::converter {

/// The body in a skeleton: an animal, or else what there is of a human.
struct FoundBody {
    std::optional<Animal> animal;
    NamedHumanoid human;
    std::optional<Humanoid> whole_human;
    /// By joint, relative to its parent: the pose in which a whole body was found, if that is not the rest pose.
    std::vector<Transform> pose;

    [[nodiscard]] bool is_whole() const { return animal || whole_human; }
    /// The joints' places in that pose.
    [[nodiscard]] RestFrames frames(const Scene& scene) const {
        return pose.empty() ? RestFrames(scene) : RestFrames(scene, pose);
    }
};

/// Looks for a human by names; if that does not give an upright body with all limbs, for an animal, and for the missing
/// parts of a human by shape. Where the rest pose does not have the shape of a whole body, looks for it in the poses of
/// the bind matrices and, if the names of a human are clear, in the frame of a clip in which it stands best, and in the
/// T of its bones. \param among  by joint: only these are considered
FoundBody find_body(const Scene& scene, const ClipRotations& clips, const std::vector<bool>& among);

}  // namespace bendy::converter
