#include <bendy/runtime/local_to_model.h>

#include "kernels/pose_kernels.h"
#include "plan/pose_plan.h"

#include <cstddef>

namespace bendy {
namespace {

static_assert(sizeof(JointTransform) == 10 * sizeof(float) && offsetof(JointTransform, translation) == 16 &&
              offsetof(JointTransform, scale) == 28);

}  // namespace

void local_to_model(Pose& pose) {
    const Model& model = *pose.model_;
    pose.is_stale_ = false;
    pose.palette_pool_ = kNone;
    if (model.joints().empty()) return;
    const PoseKernels* const kernels = pose_kernels();
    const PosePlan& plan = model.pose_plan();
    pose.is_exact_ = kernels == nullptr || !plan.fits_floats;
    if (!pose.is_exact_) {
        kernels->pose({pose.local_.size(), &pose.local_.front().rotation.x, model.parents().data(), plan.order.data(),
                       &pose.model_space_.front().matrix[0].x});
        return;
    }
    const auto joints = model.joints();
    for (std::size_t joint = 0; joint < joints.size(); ++joint) {
        const glm::dmat4 local = to_matrix(pose.local_[joint], joints[joint].shear);
        const std::uint32_t parent = joints[joint].parent;
        pose.exact_model_space_[joint] = parent == kNone ? local : pose.exact_model_space_[parent] * local;
        pose.model_space_[joint].matrix = glm::mat4(pose.exact_model_space_[joint]);
    }
}

}  // namespace bendy
