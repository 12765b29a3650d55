#include <bendy/runtime/local_to_model.h>

#include <bendy/runtime/kernels.h>

#include "pose_block.h"

#include <cstddef>

namespace bendy {
namespace {

static_assert(sizeof(JointTransform) == 10 * sizeof(float) && offsetof(JointTransform, translation) == 16 &&
              offsetof(JointTransform, scale) == 28);

}  // namespace

void local_to_model(Pose& pose) {
    const Model& model = *pose.model_;
    pose.is_stale_ = false;
    if (model.joints().empty()) return;
#if defined(__x86_64__)
    if (kernel() == Kernel::avx2 && !model.is_sheared()) {
        pose_avx2({pose.local_.size(), &pose.local_.front().rotation.x, model.parents().data(),
                   &pose.exact_model_space_.front()[0].x, &pose.model_space_.front()[0].x});
        return;
    }
#endif
    const auto joints = model.joints();
    for (std::size_t joint = 0; joint < joints.size(); ++joint) {
        const glm::dmat4 local = to_matrix(pose.local_[joint], joints[joint].shear);
        const std::uint32_t parent = joints[joint].parent;
        pose.exact_model_space_[joint] = parent == kNone ? local : pose.exact_model_space_[parent] * local;
        pose.model_space_[joint] = glm::mat4(pose.exact_model_space_[joint]);
    }
}

}  // namespace bendy
