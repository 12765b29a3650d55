// What comes out of a pose: the matrices of joints and bones, and skinned vertices.
#include "fail.h"
#include "handles.h"
#include "lookup.h"
#include "matrices.h"
#include "vertices.h"

#include <bendy/runtime/skin.h>

#include <glm/gtc/type_ptr.hpp>

#include <cstdint>

namespace bendy::capi {
namespace {

bendy_status check_method(std::uint32_t method, bendy_error* error) {
    if (method <= BENDY_SKIN_DUAL_QUATERNION) return BENDY_OK;
    return fail(error, BENDY_BAD_ARGUMENT, "expected a method of bendy_skin_method, found " + std::to_string(method));
}

/// What bendy_skin is to do, but for its outputs. `options` may be NULL.
bendy_status take_options(const bendy_pose& pose, const bendy_skin_options* options, SkinRequest& taken,
                          bendy_error* error) {
    bendy_skin_options values = BENDY_SKIN_OPTIONS_INIT;
    if (const bendy_status status = take(options, "options", values, error)) return status;
    if (values.mesh != BENDY_NONE) {
        if (const bendy_status status = check_index(values.mesh, pose.pose.model().meshes().size(), "mesh", error))
            return status;
        taken.mesh = values.mesh;
    }
    if (values.lod != nullptr) {
        if (values.lod->character != pose.character)
            return fail(error, BENDY_BAD_ARGUMENT, "lod is of another model than the pose");
        taken.lod = &values.lod->lod;
    }
    if (const bendy_status status = check_method(values.method, error)) return status;
    taken.method = static_cast<SkinningMethod>(values.method);
    return BENDY_OK;
}

/// Vertices that `out` must have room for.
std::uint64_t needed_by(const SkinRequest& request, const Model& model) {
    if (request.mesh == kAllMeshes) return model.vertex_count();
    return request.lod == nullptr ? model.meshes()[request.mesh].vertices : request.lod->vertices(request.mesh);
}

}  // namespace

}  // namespace bendy::capi

using namespace bendy::capi;

bendy_status bendy_joint_matrices(bendy_pose* pose, uint32_t first, uint32_t count, const float* world, float* matrices,
                                  bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        if (const bendy_status status = check_range(first, count, pose->pose.model().joints().size(), "joint", error))
            return status;
        if (count == 0) return BENDY_OK;
        if (const bendy_status status = check_pointer(matrices, "matrices", error)) return status;
        for (const glm::mat4& matrix : pose->pose.model_space().subspan(first, count)) {
            put_matrix(world == nullptr ? matrix : glm::make_mat4(world) * matrix, matrices);
            matrices += kMatrixNumbers;
        }
        return BENDY_OK;
    });
}

bendy_status bendy_bone_matrices(bendy_pose* pose, uint32_t mesh, float* matrices, size_t count, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        const auto meshes = pose->pose.model().meshes();
        if (const bendy_status status = check_index(mesh, meshes.size(), "mesh", error)) return status;
        if (const bendy_status status = check_skinned(meshes[mesh], mesh, error)) return status;
        if (const bendy_status status = check_pointer(matrices, "matrices", error)) return status;
        const auto palette = pose->pose.palette(mesh);
        if (const bendy_status status = check_room(count, palette.size(), "matrices", error)) return status;
        for (const bendy::PaletteMatrix& matrix : palette) {
            put_matrix(matrix, matrices);
            matrices += kMatrixNumbers;
        }
        return BENDY_OK;
    });
}

bendy_status bendy_skin(bendy_pose* pose, const bendy_skin_options* options, const bendy_vertices* out,
                        bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        bendy::SkinRequest request;
        if (const bendy_status status = take_options(*pose, options, request, error)) return status;
        const std::uint64_t needed = needed_by(request, pose->pose.model());
        if (const bendy_status status = take_buffer(out, needed, request.out, error)) return status;
        return from_call(bendy::skin(pose->pose, request), error);
    });
}

bendy_status bendy_prepare_skin(bendy_pose* pose, uint32_t method, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
        if (const bendy_status status = check_method(method, error)) return status;
        bendy::prepare_skin(pose->pose, static_cast<bendy::SkinningMethod>(method));
        return BENDY_OK;
    });
}
