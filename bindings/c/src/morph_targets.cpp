// Morph targets: their displacements, and meshes to which they are applied.
#include "calls.h"
#include "fail.h"
#include "fields.h"
#include "handles.h"
#include "lookup.h"

#include <bendy/runtime/morph_targets.h>

#include <algorithm>
#include <span>
#include <vector>

namespace bendy::capi {
namespace {

/// Writes the displacements of one attribute; zeros if the target has none. `rest` is the mesh's stream.
void copy_displacements(const MorphTargetView& target, const std::optional<StreamView>& stream, const StreamView* rest,
                        std::uint32_t vertices, float* out) {
    if (out == nullptr) return;
    for (std::uint32_t k = 0; k < vertices; ++k) {
        const bool is_there = stream && rest != nullptr;
        const glm::vec3 vector = is_there ? target.displacement(*stream, *rest, k) : glm::vec3(0.0f);
        for (int c = 0; c < 3; ++c) *out++ = vector[c];
    }
}

template <class Vector>
std::span<Vector> vectors(float* numbers, std::size_t count) {
    if (numbers == nullptr) return {};
    return {reinterpret_cast<Vector*>(numbers), count};  // NOLINT(*-reinterpret-cast): a Vector is its floats
}

const StreamView* address(const std::optional<StreamView>& stream) {
    return stream ? &*stream : nullptr;
}

}  // namespace
}  // namespace bendy::capi

using namespace bendy::capi;

bendy_status bendy::capi::get_displacements(const bendy_model* model, uint32_t morph_target, uint32_t* vertices,
                                            float* positions, float* normals, float* tangents, size_t count,
                                            bendy_error* error) {
    const auto& meshes_of = model->character->target_meshes;
    const bendy::Mesh& mesh = model->get().meshes()[meshes_of[morph_target]];
    const bendy::MorphTargetView& view =
        mesh.targets[morph_target - model->get().first_morph_target(meshes_of[morph_target])];
    const std::uint32_t touched = view.touched(mesh.vertices);
    if (const bendy_status status = check_room(count, touched, "the output", error)) return status;
    for (std::uint32_t k = 0; vertices != nullptr && k < touched; ++k) vertices[k] = view.vertex(k);
    copy_displacements(view, view.positions, &mesh.positions, touched, positions);
    copy_displacements(view, view.normals, address(mesh.normals), touched, normals);
    copy_displacements(view, view.tangents, address(mesh.tangents), touched, tangents);
    return BENDY_OK;
}

bendy_status bendy::capi::apply_morph_targets(const bendy_model* model, uint32_t mesh, const float* weights,
                                              float* positions, float* normals, float* tangents, size_t count,
                                              bendy_error* error) {
    const bendy::Mesh& view = model->get().meshes()[mesh];
    if (count > view.vertices) {
        return fail(error, BENDY_BAD_ARGUMENT,
                    "expected at most " + std::to_string(view.vertices) + " vertices, as many as mesh " +
                        std::to_string(mesh) + " has; found " + std::to_string(count));
    }
    const std::size_t targets = view.targets.size();
    const std::vector<float> zeros(weights == nullptr ? targets : 0);
    const std::span<const float> taken = weights == nullptr ? std::span(zeros) : std::span(weights, targets);
    if (const bendy_status status = check_finite(taken, "weights", error)) return status;
    const bendy::Vertices out{vectors<glm::vec3>(positions, count), vectors<glm::vec3>(normals, count),
                              vectors<glm::vec4>(tangents, count)};
    return from_call(bendy::apply_morph_targets(view, taken, static_cast<std::uint32_t>(count), out), error);
}
