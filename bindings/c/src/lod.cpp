// Submeshes, and levels of detail.
#include "calls.h"
#include "fail.h"
#include "fields.h"
#include "handles.h"
#include "lookup.h"

using namespace bendy::capi;

bendy_status bendy::capi::get_submesh(const bendy_model* model, uint32_t submesh, bendy_submesh& out,
                                      bendy_error* /*error*/) {
    to_c(model->get().submeshes()[submesh], out);
    return BENDY_OK;
}

bendy_status bendy::capi::lod_new(const bendy_model* model, bendy_lod*& made, bendy_error* /*error*/) {
    made = std::make_unique<bendy_lod>(model->character).release();
    return BENDY_OK;
}

uint32_t bendy_has_levels(const bendy_model* model) {
    return model != nullptr && model->get().collapse() != nullptr ? 1 : 0;
}

bendy_status bendy::capi::lod_set_share(bendy_lod* lod, float share, bendy_error* /*error*/) {
    lod->lod.set_share(share);
    return BENDY_OK;
}

bendy_status bendy::capi::get_lod(const bendy_lod* lod, bendy_lod_info& out, bendy_error* /*error*/) {
    out = {0, lod->lod.error(), lod->lod.triangles()};
    return BENDY_OK;
}

uint32_t bendy_lod_vertices(const bendy_lod* lod, uint32_t mesh) {
    if (lod == nullptr || mesh >= lod->character->model.meshes().size()) return 0;
    return lod->lod.vertices(mesh);
}

bendy_status bendy::capi::lod_indices(const bendy_lod* lod, uint32_t mesh, size_t* count, const uint32_t*& made,
                                      bendy_error* /*error*/) {
    const auto list = lod->lod.indices(mesh);
    *count = list.size();
    if (!list.empty()) made = list.data();
    return BENDY_OK;
}

bendy_status bendy::capi::lod_submesh(const bendy_lod* lod, uint32_t submesh, bendy_submesh& out,
                                      bendy_error* /*error*/) {
    to_c(lod->lod.submeshes()[submesh], out);
    return BENDY_OK;
}
