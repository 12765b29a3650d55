#include <bendy/runtime/local_to_model.h>

namespace bendy {

void local_to_model(Pose& pose) {
    const auto joints = pose.model_->joints();
    for (std::size_t joint = 0; joint < joints.size(); ++joint) {
        const glm::dmat4 local = to_matrix(pose.local_[joint], joints[joint].shear);
        const std::uint32_t parent = joints[joint].parent;
        pose.exact_model_space_[joint] = parent == kNone ? local : pose.exact_model_space_[parent] * local;
        pose.model_space_[joint] = glm::mat4(pose.exact_model_space_[joint]);
    }
    pose.is_stale_ = false;
}

}  // namespace bendy
