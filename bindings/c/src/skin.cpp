// Results of a pose: the matrices of joints and bones, and skinned vertices.
#include "calls.h"
#include "fail.h"
#include "fields.h"
#include "handles.h"
#include "lookup.h"
#include "matrices.h"
#include "vertices.h"

#include <bendy/runtime/skin.h>

#include <glm/gtc/type_ptr.hpp>

#include <cstdint>

namespace bendy::capi {
namespace {

/// Converts the options of bendy_skin; the caller sets the outputs.
bendy_status take_options(const bendy_pose& pose, const bendy_skin_options& options, SkinRequest& taken,
                          bendy_error* error) {
    if (options.mesh != BENDY_NONE) {
        if (const bendy_status status = check_index(options.mesh, parts(pose).mesh(), "mesh", error)) return status;
        taken.mesh = options.mesh;
    }
    if (const bendy_status status = check_same_model(options.lod, pose, "lod", "pose", error)) return status;
    if (options.lod != nullptr) taken.lod = &options.lod->lod;
    taken.method = static_cast<SkinningMethod>(options.method);
    return BENDY_OK;
}

/// The number of vertices that `out` must have room for.
std::uint64_t needed_by(const SkinRequest& request, const Model& model) {
    if (request.mesh == kAllMeshes) return model.vertex_count();
    return request.lod == nullptr ? model.meshes()[request.mesh].vertices : request.lod->vertices(request.mesh);
}

}  // namespace

}  // namespace bendy::capi

using namespace bendy::capi;

bendy_status bendy::capi::joint_matrices(bendy_pose* pose, uint32_t first, uint32_t count, const float* world,
                                         float* matrices, bendy_error* error) {
    if (const bendy_status status = check_range(first, count, parts(*pose).joint(), "joint", error)) return status;
    if (count == 0) return BENDY_OK;
    if (const bendy_status status = check_pointer(matrices, "matrices", error)) return status;
    for (const glm::mat4& matrix : pose->pose.model_space().subspan(first, count)) {
        put_matrix(world == nullptr ? matrix : glm::make_mat4(world) * matrix, matrices);
        matrices += kMatrixNumbers;
    }
    return BENDY_OK;
}

bendy_status bendy::capi::bone_matrices(bendy_pose* pose, uint32_t mesh, float* matrices, size_t count,
                                        bendy_error* error) {
    const auto meshes = pose->pose.model().meshes();
    if (const bendy_status status = check_skinned(meshes[mesh], mesh, error)) return status;
    const auto palette = pose->pose.palette(mesh);
    if (const bendy_status status = check_room(count, palette.size(), "matrices", error)) return status;
    for (const bendy::PaletteMatrix& matrix : palette) {
        put_matrix(matrix, matrices);
        matrices += kMatrixNumbers;
    }
    return BENDY_OK;
}

bendy_status bendy::capi::skin(bendy_pose* pose, const bendy_skin_options& options, const bendy_vertices& out,
                               bendy_error* error) {
    bendy::SkinRequest request;
    if (const bendy_status status = take_options(*pose, options, request, error)) return status;
    const std::uint64_t needed = needed_by(request, pose->pose.model());
    if (const bendy_status status = take_buffer(out, needed, request.out, error)) return status;
    return from_call(bendy::skin(pose->pose, request), error);
}

bendy_status bendy::capi::prepare_skin(bendy_pose* pose, uint32_t method, bendy_error* /*error*/) {
    bendy::prepare_skin(pose->pose, static_cast<bendy::SkinningMethod>(method));
    return BENDY_OK;
}
