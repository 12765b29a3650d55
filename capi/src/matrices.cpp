// The matrices of joints and bones.
#include "fail.h"
#include "handles.h"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>

namespace bendy::capi {
namespace {

constexpr std::size_t kNumbers = 16;  // per matrix

void put_matrix(const glm::mat4& matrix, float* out) {
    std::copy_n(glm::value_ptr(matrix), kNumbers, out);
}

/// Writes the rows of a 3x4 matrix as the columns of a 4x4 one.
void put_matrix(const PaletteMatrix& matrix, float* out) {
    for (int column = 0; column < 4; ++column) {
        for (const auto& row : matrix.rows) *out++ = row[column];
        *out++ = column == 3 ? 1.0f : 0.0f;
    }
}

}  // namespace
}  // namespace bendy::capi

using namespace bendy::capi;

bendy_status bendy_joint_matrices(bendy_pose* pose, uint32_t first, uint32_t count, const float* world, float* matrices,
                                  bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        const std::size_t joints = pose->pose.model().joints().size();
        if (const bendy_status status = check_range(first, count, joints, "joint", error)) return status;
        if (count == 0) return BENDY_OK;
        if (const bendy_status status = check_pointer(matrices, "matrices", error)) return status;
        for (const glm::mat4& matrix : pose->pose.model_space().subspan(first, count)) {
            put_matrix(world == nullptr ? matrix : glm::make_mat4(world) * matrix, matrices);
            matrices += kNumbers;
        }
        return BENDY_OK;
    });
}

bendy_status bendy_bone_matrices(bendy_pose* pose, uint32_t mesh, float* matrices, size_t count, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        const auto meshes = pose->pose.model().meshes();
        if (const bendy_status status = check_index(mesh, meshes.size(), "mesh", error)) return status;
        if (meshes[mesh].is_rigid())
            return fail(error, BENDY_BAD_ARGUMENT, "mesh " + std::to_string(mesh) + " is rigid: it has no bones");
        if (const bendy_status status = check_pointer(matrices, "matrices", error)) return status;
        const auto palette = pose->pose.palette(mesh);
        if (const bendy_status status = check_room(count, palette.size(), "matrices", error)) return status;
        for (const bendy::PaletteMatrix& matrix : palette) {
            put_matrix(matrix, matrices);
            matrices += kNumbers;
        }
        return BENDY_OK;
    });
}
