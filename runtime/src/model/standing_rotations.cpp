#include "standing_rotations.h"

#include <array>
#include <span>

namespace bendy {

std::vector<StandingJoint> standing_rotations(const Model& model) {
    if (model.standing_pose() == nullptr) return {};
    std::span<const StandingRotationRecord> records = model.standing_pose()->rotations;
    const auto joints = model.joints();
    std::vector<StandingJoint> standing;
    standing.reserve(records.size());
    std::vector<glm::dquat> turns;  // to model space
    turns.reserve(joints.size());
    for (std::uint32_t joint = 0; joint < joints.size(); ++joint) {  // parents come first
        const std::uint32_t parent = joints[joint].parent;
        const glm::dquat above = parent == kNone ? glm::dquat(1.0, 0.0, 0.0, 0.0) : turns[parent];
        glm::dquat own = glm::normalize(glm::dquat(joints[joint].rest.rotation));
        if (!records.empty() && records.front().joint == joint) {
            const std::array<float, 4> xyzw = rotation_of(records.front());
            own = glm::normalize(glm::conjugate(above) * glm::dquat(xyzw[3], xyzw[0], xyzw[1], xyzw[2]));
            standing.push_back({joint, glm::quat(own)});
            records = records.subspan(1);
        }
        turns.push_back(glm::normalize(above * own));
    }
    return standing;
}

}  // namespace bendy
