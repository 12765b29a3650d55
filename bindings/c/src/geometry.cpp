// The data of a model's meshes that posing does not change: index lists, texture coordinates, influences, bind
// palettes, and the joints that move rigid meshes.
#include "calls.h"
#include "fail.h"
#include "fields.h"
#include "handles.h"
#include "lookup.h"
#include "matrices.h"

#include <algorithm>
#include <span>
#include <string>

namespace bendy::capi {
namespace {

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

}  // namespace

}  // namespace bendy::capi

using namespace bendy::capi;

bendy_status bendy::capi::get_indices(const bendy_model* model, uint32_t mesh, uint32_t* indices, size_t count,
                                      bendy_error* error) {
    const auto& stream = model->get().meshes()[mesh].indices;
    const std::uint32_t elements = stream ? stream->elements : 0;
    if (elements == 0) return BENDY_OK;
    if (const bendy_status status = check_pointer(indices, "indices", error)) return status;
    if (const bendy_status status = check_room(count, elements, "indices", error)) return status;
    for (std::uint32_t k = 0; k < elements; ++k) indices[k] = stream->index(k, 0);
    return BENDY_OK;
}

bendy_status bendy::capi::get_texture_coords(const bendy_model* model, uint32_t mesh, uint32_t set, float* uv,
                                             size_t count, bendy_error* error) {
    const bendy::Mesh& view = model->get().meshes()[mesh];
    const bendy::StreamView* stream = texture_coords(view, set);
    if (stream == nullptr) {
        return fail(error, BENDY_BAD_ARGUMENT,
                    "mesh " + std::to_string(mesh) + " has no texture coordinates of set " + std::to_string(set));
    }
    if (const bendy_status status = check_room(count, std::uint64_t{2} * view.vertices, "uv", error)) return status;
    for (std::uint32_t vertex = 0; vertex < view.vertices; ++vertex) {
        for (std::uint32_t c = 0; c < 2; ++c) *uv++ = stream->number(vertex, c);
    }
    return BENDY_OK;
}

bendy_status bendy::capi::get_influences(const bendy_model* model, uint32_t mesh, uint32_t* bones, float* weights,
                                         size_t count, bendy_error* error) {
    const bendy::Mesh& view = model->get().meshes()[mesh];
    if (const bendy_status status = check_skinned(view, mesh, error)) return status;
    const std::uint64_t needed = std::uint64_t{view.vertices} * view.bones->components;
    if (const bendy_status status = check_room(count, needed, "bones", error)) return status;
    copy_influences(view, bones, weights);
    return BENDY_OK;
}

bendy_status bendy::capi::get_bind_palette(const bendy_model* model, uint32_t mesh, uint32_t* joints,
                                           float* inverse_bind, size_t count, bendy_error* error) {
    const bendy::Mesh& view = model->get().meshes()[mesh];
    if (const bendy_status status = check_skinned(view, mesh, error)) return status;
    const std::span<const std::uint32_t> from = view.palette.joints;
    if (const bendy_status status = check_room(count, from.size(), "the palette", error)) return status;
    if (joints != nullptr) std::copy(from.begin(), from.end(), joints);
    if (inverse_bind == nullptr) return BENDY_OK;
    for (const glm::mat4& matrix : view.palette.inverse_bind()) {
        put_matrix(matrix, inverse_bind);
        inverse_bind += kMatrixNumbers;
    }
    return BENDY_OK;
}

bendy_status bendy::capi::get_movers(const bendy_model* model, uint32_t mesh, uint32_t* joints, size_t count,
                                     bendy_error* error) {
    const bendy::Mesh& view = model->get().meshes()[mesh];
    if (!view.is_rigid())
        return fail(error, BENDY_BAD_ARGUMENT, "mesh " + std::to_string(mesh) + " is not rigid: its bones move it");
    if (view.vertices == 0) return BENDY_OK;
    if (const bendy_status status = check_pointer(joints, "joints", error)) return status;
    if (const bendy_status status = check_room(count, view.vertices, "joints", error)) return status;
    for (std::uint32_t vertex = 0; vertex < view.vertices; ++vertex)
        joints[vertex] = model->get().rigid_mover(mesh, vertex);
    return BENDY_OK;
}
