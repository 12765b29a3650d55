// Skinned vertices into the caller's memory.
#include <bendy/runtime/skin.h>

#include "handles.h"
#include "sized.h"

#include <cstdint>
#include <limits>

namespace bendy::capi {
namespace {

/// One attribute of `numbers` floats, for so many vertices.
bendy_status take_array(float* data, std::size_t stride, std::size_t numbers, std::uint64_t vertices, const char* name,
                        StridedFloats& out, bendy_error* error) {
    if (data == nullptr || vertices == 0) return BENDY_OK;
    if (stride == 0) stride = numbers * sizeof(float);
    if (stride % sizeof(float) != 0 || stride < numbers * sizeof(float))
        return fail(error, BENDY_BAD_ARGUMENT,
                    std::string(name) + ": a stride of " + std::to_string(stride) +
                        " bytes is no multiple of 4 that holds " + std::to_string(numbers) + " floats");
    if (reinterpret_cast<std::uintptr_t>(data) % alignof(float) != 0)  // NOLINT(*-reinterpret-cast)
        return fail(error, BENDY_BAD_ARGUMENT, std::string(name) + " does not start on a 4-byte boundary");
    out.stride = stride / sizeof(float);
    constexpr std::size_t kMost = std::numeric_limits<std::ptrdiff_t>::max() / sizeof(float);
    if (out.stride > kMost || vertices - 1 > (kMost - numbers) / out.stride)
        return fail(error, BENDY_BAD_ARGUMENT, std::string(name) + ": no memory is that large");
    out.floats = {data, (vertices - 1) * out.stride + numbers};
    return BENDY_OK;
}

bendy_status take_buffer(const bendy_vertices* vertices, std::uint64_t needed, VertexBuffer& out, bendy_error* error) {
    if (const bendy_status status = check_pointer(vertices, "out", error)) return status;
    bendy_vertices values = BENDY_VERTICES_INIT;
    if (const bendy_status status = take(vertices, "out", values, error)) return status;
    if (const bendy_status status = check_room(values.capacity, needed, "out", error)) return status;
    if (const bendy_status status =
            take_array(values.positions, values.position_stride, 3, needed, "positions", out.positions, error))
        return status;
    if (const bendy_status status =
            take_array(values.normals, values.normal_stride, 3, needed, "normals", out.normals, error))
        return status;
    return take_array(values.tangents, values.tangent_stride, 4, needed, "tangents", out.tangents, error);
}

bendy_status check_skin(const bendy_pose* pose, const bendy_lod* lod, bendy_error* error) {
    if (const bendy_status status = check_pointer(pose, "pose", error)) return status;
    if (lod == nullptr || lod->character == pose->character) return BENDY_OK;
    return fail(error, BENDY_BAD_ARGUMENT, "lod is of another model than the pose");
}

}  // namespace
}  // namespace bendy::capi

using namespace bendy::capi;

bendy_status bendy_skin(bendy_pose* pose, const bendy_lod* lod, const bendy_vertices* out, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_skin(pose, lod, error)) return status;
        const bendy::Model& model = pose->character->model;
        bendy::VertexBuffer buffer;
        if (const bendy_status status = take_buffer(out, model.vertex_count(), buffer, error)) return status;
        const bool done = lod == nullptr ? bendy::skin_into(model, pose->pose, buffer)
                                         : bendy::skin_into(model, pose->pose, lod->lod, buffer);
        return done ? BENDY_OK : fail(error, BENDY_BAD_ARGUMENT, "out is too short");
    });
}

bendy_status bendy_skin_mesh(bendy_pose* pose, uint32_t mesh, const bendy_lod* lod, const bendy_vertices* out,
                             bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_skin(pose, lod, error)) return status;
        const bendy::Model& model = pose->character->model;
        if (const bendy_status status = check_index(mesh, model.pools().size(), "mesh", error)) return status;
        const std::uint32_t needed = lod == nullptr ? model.pools()[mesh].vertices : lod->lod.vertices(mesh);
        bendy::VertexBuffer buffer;
        if (const bendy_status status = take_buffer(out, needed, buffer, error)) return status;
        const bool done = lod == nullptr ? bendy::skin_into(model, mesh, pose->pose, buffer)
                                         : bendy::skin_into(model, mesh, pose->pose, lod->lod, buffer);
        return done ? BENDY_OK : fail(error, BENDY_BAD_ARGUMENT, "out is too short");
    });
}
