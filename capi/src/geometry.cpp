// The data of a model's meshes that posing does not change: submeshes, index lists, texture coordinates, influences;
// levels of detail.
#include "fail.h"
#include "handles.h"

namespace bendy::capi {
namespace {

bendy_status check_mesh(const bendy_model* model, std::uint32_t mesh, bendy_error* error) {
    if (const bendy_status status = check_pointer(model, "model", error)) return status;
    return check_index(mesh, model->get().meshes().size(), "mesh", error);
}

/// Returns the mesh's texture coordinates of that set; null if there are none.
const StreamView* texture_coords(const Mesh& mesh, std::uint32_t set) {
    for (const StreamView& stream : mesh.texture_coords) {
        if (stream.set == set) return &stream;
    }
    return nullptr;
}

void copy_influences(const Mesh& mesh, std::uint32_t* bones, float* weights) {
    const std::uint32_t influences = mesh.bones->components;
    for (std::uint32_t vertex = 0; vertex < mesh.vertices; ++vertex) {
        for (std::uint32_t k = 0; k < influences; ++k) {
            *bones++ = mesh.bones->index(vertex, k);
            *weights++ = mesh.weights->number(vertex, k);
        }
    }
}

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

bendy_status bendy_get_indices(const bendy_model* model, uint32_t mesh, uint32_t* indices, size_t count,
                               bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_mesh(model, mesh, error)) return status;
        const auto& stream = model->get().meshes()[mesh].indices;
        const std::uint32_t elements = stream ? stream->elements : 0;
        if (elements == 0) return BENDY_OK;
        if (const bendy_status status = check_pointer(indices, "indices", error)) return status;
        if (const bendy_status status = check_room(count, elements, "indices", error)) return status;
        for (std::uint32_t k = 0; k < elements; ++k) indices[k] = stream->index(k, 0);
        return BENDY_OK;
    });
}

bendy_status bendy_get_texture_coords(const bendy_model* model, uint32_t mesh, uint32_t set, float* uv, size_t count,
                                      bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_mesh(model, mesh, error)) return status;
        const bendy::Mesh& view = model->get().meshes()[mesh];
        const bendy::StreamView* stream = texture_coords(view, set);
        if (stream == nullptr)
            return fail(error, BENDY_BAD_ARGUMENT,
                        "mesh " + std::to_string(mesh) + " has no texture coordinates of set " + std::to_string(set));
        if (const bendy_status status = check_pointer(uv, "uv", error)) return status;
        if (const bendy_status status = check_room(count, std::uint64_t{2} * view.vertices, "uv", error)) return status;
        for (std::uint32_t vertex = 0; vertex < view.vertices; ++vertex) {
            for (std::uint32_t c = 0; c < 2; ++c) *uv++ = stream->number(vertex, c);
        }
        return BENDY_OK;
    });
}

bendy_status bendy_get_influences(const bendy_model* model, uint32_t mesh, uint32_t* bones, float* weights,
                                  size_t count, bendy_error* error) {
    return guarded(error, [&] {
        if (const bendy_status status = check_mesh(model, mesh, error)) return status;
        const bendy::Mesh& view = model->get().meshes()[mesh];
        if (view.is_rigid())
            return fail(error, BENDY_BAD_ARGUMENT, "mesh " + std::to_string(mesh) + " is rigid: it has no bones");
        if (const bendy_status status = check_pointer(bones, "bones", error)) return status;
        if (const bendy_status status = check_pointer(weights, "weights", error)) return status;
        const std::uint64_t needed = std::uint64_t{view.vertices} * view.bones->components;
        if (const bendy_status status = check_room(count, needed, "bones", error)) return status;
        copy_influences(view, bones, weights);
        return BENDY_OK;
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
