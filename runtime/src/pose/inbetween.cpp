#include <bendy/runtime/inbetween.h>

#include "model/frame_shape.h"

#include <algorithm>
#include <cassert>
#include <cstdint>

namespace bendy {
namespace {

/// Decodes a stream's vectors, or zeros if the pool has none.
template <class Vector>
void fill(const std::optional<StreamView>& stream, std::uint32_t vertices, std::span<Vector> out) {
    if (out.empty()) return;
    if (!stream) {
        std::fill_n(out.begin(), vertices, Vector(0.0f));
        return;
    }
    stream->decode(out.first(vertices));
}

template <class Vector>
void displace(const TargetView& target, const std::optional<StreamView>& stream, float weight, std::uint32_t vertices,
              std::span<Vector> out) {
    if (!stream || out.empty()) return;
    if (target.is_frame()) return add_frame(*target.places, *stream, weight, 0, out.first(vertices));
    const auto displacements = view_at<glm::vec3>(stream->data, 0, stream->elements);
    const bool is_plain = stream->type == ComponentType::f32;
    for (std::uint32_t entry = 0; entry < stream->elements; ++entry) {
        const std::uint32_t vertex = target.vertices ? target.vertices->index(entry, 0) : entry;
        if (vertex >= vertices) return;  // they ascend
        const glm::vec3 displacement = is_plain ? displacements[entry] : stream->vec3(entry);
        Vector& vector = out[vertex];
        vector.x += weight * displacement.x;
        vector.y += weight * displacement.y;
        vector.z += weight * displacement.z;
    }
}

}  // namespace

Result<void, CallError> inbetween(const Pool& pool, std::span<const float> weights, const Vertices& out) {
    return inbetween(pool, weights, pool.vertices, out);
}

Result<void, CallError> inbetween(const Pool& pool, std::span<const float> weights, std::uint32_t vertices,
                                  const Vertices& out) {
    assert(vertices <= pool.vertices);
    const auto too_short = [&](const auto& span) { return !span.empty() && span.size() < vertices; };
    if (too_short(out.positions) || too_short(out.normals) || too_short(out.tangents))
        return CallError::output_too_short;
    if (weights.size() < pool.targets.size()) return CallError::wrong_size;

    fill<glm::vec3>(pool.positions, vertices, out.positions);
    fill<glm::vec3>(pool.normals, vertices, out.normals);
    fill<glm::vec4>(pool.tangents, vertices, out.tangents);
    const float share = rest_share(pool, weights);
    if (have_frames(pool, &TargetView::positions) && !out.positions.empty())
        lighten(share, out.positions.first(vertices));
    if (have_frames(pool, &TargetView::normals) && pool.normals && !out.normals.empty())
        lighten(share, out.normals.first(vertices));
    for (std::size_t k = 0; k < pool.targets.size(); ++k) {
        if (weights[k] == 0.0f) continue;
        const TargetView& target = pool.targets[k];
        displace(target, target.positions, weights[k], vertices, out.positions);
        if (pool.normals) displace(target, target.normals, weights[k], vertices, out.normals);
        if (pool.tangents) displace(target, target.tangents, weights[k], vertices, out.tangents);
    }
    return {};
}

}  // namespace bendy
