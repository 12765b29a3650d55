#include <bendy/runtime/morph_targets.h>

#include "active_target.h"
#include "model/frame_shape.h"

#include <algorithm>
#include <cstdint>

namespace bendy {
namespace {

/// Decodes the vectors of a stream; zeros if the mesh does not have it.
template <class Vector>
void fill(const std::optional<StreamView>& stream, std::uint32_t vertices, std::span<Vector> out) {
    if (out.empty()) return;
    if (!stream) {
        std::fill_n(out.begin(), vertices, Vector(0.0f));
        return;
    }
    stream->decode(out.first(vertices));
}

}  // namespace

Result<void, CallError> apply_morph_targets(const Mesh& mesh, std::span<const float> weights, const Vertices& out) {
    return apply_morph_targets(mesh, weights, mesh.vertices, out);
}

Result<void, CallError> apply_morph_targets(const Mesh& mesh, std::span<const float> weights, std::uint32_t vertices,
                                            const Vertices& out) {
    if (vertices > mesh.vertices) return CallError::out_of_range;
    const auto too_short = [&](const auto& span) { return !span.empty() && span.size() < vertices; };
    if (too_short(out.positions) || too_short(out.normals) || too_short(out.tangents))
        return CallError::output_too_short;
    if (weights.size() < mesh.targets.size()) return CallError::wrong_size;

    fill<glm::vec3>(mesh.positions, vertices, out.positions);
    fill<glm::vec3>(mesh.normals, vertices, out.normals);
    fill<glm::vec4>(mesh.tangents, vertices, out.tangents);
    const float share = rest_share(mesh, weights);
    if (have_frames(mesh, &MorphTargetView::positions) && !out.positions.empty())
        lighten(share, out.positions.first(vertices));
    if (have_frames(mesh, &MorphTargetView::normals) && mesh.normals && !out.normals.empty())
        lighten(share, out.normals.first(vertices));
    for (std::size_t k = 0; k < mesh.targets.size(); ++k) {
        if (weights[k] == 0.0f) continue;
        const MorphTargetView& target = mesh.targets[k];
        ActiveTarget active(target, weights[k]);
        active.seek(0, vertices);
        const auto add = [&](const std::optional<StreamView>& shifts, const auto& vectors) {
            if (shifts && !vectors.empty()) active.add(*shifts, vectors.first(vertices));
        };
        add(target.positions, out.positions);
        if (mesh.normals) add(target.normals, out.normals);
        if (mesh.tangents) add(target.tangents, out.tangents);
    }
    return {};
}

}  // namespace bendy
