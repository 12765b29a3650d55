// Submeshes, and levels of detail.
#include "fail.h"
#include "handles.h"
#include "lookup.h"

namespace bendy::capi {
namespace {

/// Fills `out` with one of `submeshes`: the model's, or those at a level of detail.
bendy_status get_submesh(std::span<const Submesh> submeshes, std::uint32_t number, bendy_submesh* out,
                         bendy_error* error) {
    if (const bendy_status status = check_index(number, submeshes.size(), "submesh", error)) return status;
    if (const bendy_status status = check_out(out, "out", error)) return status;
    const Submesh& submesh = submeshes[number];
    put(*out, {0, submesh.mesh, submesh.material, static_cast<std::uint32_t>(submesh.topology), submesh.first,
               submesh.count});
    return BENDY_OK;
}

}  // namespace
}  // namespace bendy::capi

using namespace bendy::capi;

bendy_status bendy_get_submesh(const bendy_model* model, uint32_t submesh, bendy_submesh* out, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        return get_submesh(model->get().submeshes(), submesh, out, error);
    });
}

bendy_lod* bendy_lod_new(const bendy_model* model, bendy_error* error) {
    bendy_lod* lod = nullptr;
    guarded(error, [&] {
        if (const bendy_status status = check_pointer(model, "model", error)) return status;
        lod = std::make_unique<bendy_lod>(model->character).release();
        return BENDY_OK;
    });
    return lod;
}

void bendy_lod_free(bendy_lod* lod) {
    delete lod;
}

uint32_t bendy_has_levels(const bendy_model* model) {
    return model != nullptr && model->get().collapse() != nullptr ? 1 : 0;
}

bendy_status bendy_lod_set_share(bendy_lod* lod, float share, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(lod, "lod", error)) return status;
        if (!(share >= 0.0f && share <= 1.0f)) return fail(error, BENDY_BAD_ARGUMENT, "share must lie between 0 and 1");
        lod->lod.set_share(share);
        return BENDY_OK;
    });
}

bendy_status bendy_get_lod(const bendy_lod* lod, bendy_lod_info* out, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(lod, "lod", error)) return status;
        if (const bendy_status status = check_out(out, "out", error)) return status;
        put(*out, {0, lod->lod.error(), lod->lod.triangles()});
        return BENDY_OK;
    });
}

uint32_t bendy_lod_vertices(const bendy_lod* lod, uint32_t mesh) {
    if (lod == nullptr || mesh >= lod->character->model.meshes().size()) return 0;
    return lod->lod.vertices(mesh);
}

const uint32_t* bendy_lod_indices(const bendy_lod* lod, uint32_t mesh, size_t* count, bendy_error* error) {
    const uint32_t* indices = nullptr;
    guarded(error, [&] {
        if (const bendy_status status = check_pointer(lod, "lod", error)) return status;
        if (const bendy_status status = check_pointer(count, "count", error)) return status;
        if (const bendy_status status = check_index(mesh, lod->character->model.meshes().size(), "mesh", error))
            return status;
        const auto list = lod->lod.indices(mesh);
        *count = list.size();
        if (!list.empty()) indices = list.data();
        return BENDY_OK;
    });
    return indices;
}

bendy_status bendy_lod_submesh(const bendy_lod* lod, uint32_t submesh, bendy_submesh* out, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_pointer(lod, "lod", error)) return status;
        return get_submesh(lod->lod.submeshes(), submesh, out, error);
    });
}
