#include "kernels/flush_denormals.h"
#include "kernels/pose_kernels.h"
#include "pose_state.h"

#include <cstdint>

namespace bendy {
void PoseState::find_model_space() {
    is_stale = false;
    palette_mesh = kNone;
    const std::vector<Joint>& joints = data->joints;
    if (joints.empty()) return;
    const PoseKernels* const kernels = pose_kernels();
    const PosePlan& plan = *data->pose_plan;
    is_exact = kernels == nullptr || !plan.fits_floats;
    if (!is_exact) {
        const FlushDenormals flush;
        kernels->pose({joints.size(), &local.front().rotation[0][0], data->parents.data(), plan.order.data(),
                       &model_space.front().matrix[0].x});
        return;
    }
    for (std::uint32_t joint = 0; joint < joints.size(); ++joint) {
        const glm::dmat4 matrix = to_matrix(local_of(joint), joints[joint].shear);
        const std::uint32_t parent = joints[joint].parent;
        exact_model_space[joint] = parent == kNone ? matrix : exact_model_space[parent] * matrix;
        model_space[joint].matrix = glm::mat4(exact_model_space[joint]);
    }
}

}  // namespace bendy
