#include "pose_state.h"

#include "kernels/flush_denormals.h"
#include "kernels/kernel_table.h"
#include "math/rigid_part.h"
#include "plan/layout.h"

#include <bendy/runtime/socket.h>

#include <algorithm>
#include <cstdint>

namespace bendy {
void PoseState::find_model_space() {
    palette_mesh = kNone;
    const KernelTable& kernels = kernel_table();  // once, since another thread may choose another one
    std::uint32_t changed = 0;
    for (const StaleJoints::Subtree& subtree : stale.subtrees()) changed += subtree.end - subtree.joint;
    if (stale.are_all() || changed > joint_count() / 2) {
        find_subtree({0, joint_count()}, kernels);
    } else {
        for (const StaleJoints::Subtree& subtree : stale.subtrees()) find_subtree(subtree, kernels);
    }
    stale.clear();
}

void PoseState::find_subtree(const StaleJoints::Subtree& subtree, const KernelTable& kernels) {
    if (joint_count() == 0) return;
    if (is_exact) return find_exactly(subtree);
    const FlushDenormals flush(kernels.flushes_denormals);
    const PoseBlock block{joint_count(), &local.front().rotation[0][0], data->parents.data(),
                          data->pose_plan->order.data(), &model_space.front().matrix[0].x};
    if (subtree.end - subtree.joint == joint_count()) {
        kernels.pose(block);
    } else {
        kernels.pose_subtree(block, subtree.joint, subtree.end);
    }
}

void PoseState::find_exactly(const StaleJoints::Subtree& subtree) {
    const std::vector<Joint>& joints = data->joints;
    for (std::uint32_t joint = subtree.joint; joint < subtree.end; ++joint) {
        const glm::dmat4 matrix = to_matrix(local_of(joint), joints[joint].shear);
        const std::uint32_t parent = joints[joint].parent;
        exact_model_space[joint] = parent == kNone ? matrix : exact_model_space[parent] * matrix;
        model_space[joint].matrix = glm::mat4(exact_model_space[joint]);
    }
}

namespace {

bool is_finite(const PaletteMatrix& entry) {
    float sum = 0.0f;
    for (const auto& row : entry.rows) {
        for (const float number : row) sum += 0.0f * number;
    }
    return sum == 0.0f;
}

}  // namespace

bool PoseState::make_palette(std::uint32_t mesh) {
    mesh = data->pose_plan->same_palette[mesh];
    if (palette_mesh == mesh) return is_palette_finite;
    palette_mesh = mesh;
    is_palette_finite = compute_palette(mesh, palette.data());
    return is_palette_finite;
}

void PoseState::write_palette(std::uint32_t mesh, std::span<PaletteMatrix> out) const {
    mesh = data->pose_plan->same_palette[mesh];
    if (palette_mesh == mesh) {
        std::copy_n(palette.begin(), out.size(), out.begin());
    } else {
        (void)compute_palette(mesh, out.data());
    }
}

bool PoseState::compute_palette(std::uint32_t mesh, PaletteMatrix* out) const {
    const PaletteView& bind = data->object.meshes[mesh].palette;
    if (bind.joints.empty()) return true;
    if (!is_exact) {
        const KernelTable& kernels = kernel_table();
        const std::vector<PaletteMatrix>& inverse_bind = data->pose_plan->inverse_bind[mesh];
        const FlushDenormals flush(kernels.flushes_denormals);
        return kernels.palette(
            {bind.joints.size(), &model_space.front().matrix[0].x, bind.joints.data(), inverse_bind.data(), out});
    }
    const auto inverse_bind = bind.inverse_bind();
    bool are_finite = true;
    for (std::size_t entry = 0; entry < bind.joints.size(); ++entry) {
        // Large translations cancel here, so the product must be computed in doubles.
        out[entry] = to_rows(exact_matrix(bind.joints[entry]) * glm::dmat4(inverse_bind[entry]));
        are_finite = are_finite && is_finite(out[entry]);
    }
    return are_finite;
}

void PoseState::make_rigid_palette(std::uint32_t joint) {
    palette_mesh = kNone;
    palette.front() = to_rows(exact_matrix(joint));
}

Socket make_socket(const Model& model, std::string_view joint, const glm::mat4& offset) {
    Socket socket;
    socket.joint = model.joint(joint);
    socket.offset = offset;
    return socket;
}

Result<glm::mat4, CallError> socket_matrix(Pose& pose, const Socket& socket, const glm::mat4& model_to_world) {
    glm::dmat4 joint(1.0);
    if (socket.joint != kNone) {
        if (socket.joint >= pose.model().joints().size()) return CallError::out_of_range;
        joint = glm::dmat4(pose.model_space()[socket.joint]);
        if (socket.keeps_size) joint = rigid_part(joint);
    }
    return glm::mat4(glm::dmat4(model_to_world) * joint * glm::dmat4(socket.offset));
}

}  // namespace bendy
