#include "blend_poses.h"

#include <glm/common.hpp>

namespace bendy::viewer {

void blend_poses(const Pose& other, float share, Pose& pose) {
    const auto local = pose.change_local();
    for (std::size_t joint = 0; joint < local.size(); ++joint) {
        const JointTransform& towards = other.local()[joint];
        local[joint].rotation = glm::normalize(glm::slerp(local[joint].rotation, towards.rotation, share));
        local[joint].translation = glm::mix(local[joint].translation, towards.translation, share);
        local[joint].scale = glm::mix(local[joint].scale, towards.scale, share);
    }
    const auto weights = pose.change_target_weights();
    for (std::size_t k = 0; k < weights.size(); ++k)
        weights[k] = glm::mix(weights[k], other.target_weights()[k], share);
}

}  // namespace bendy::viewer
