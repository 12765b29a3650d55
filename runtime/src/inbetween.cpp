#include <bendy/runtime/inbetween.h>

#include <algorithm>
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
void displace(const TargetView& target, const std::optional<StreamView>& stream, float weight, std::span<Vector> out) {
    if (!stream || out.empty()) return;
    const auto add = [&](std::uint32_t entry, const glm::vec3& displacement) {
        Vector& vector = out[target.vertices ? target.vertices->index(entry, 0) : entry];
        vector.x += weight * displacement.x;
        vector.y += weight * displacement.y;
        vector.z += weight * displacement.z;
    };
    if (stream->type == ComponentType::f32) {
        const auto displacements = view_at<glm::vec3>(stream->data, 0, stream->elements);
        for (std::uint32_t entry = 0; entry < displacements.size(); ++entry) add(entry, displacements[entry]);
    } else {
        for (std::uint32_t entry = 0; entry < stream->elements; ++entry) add(entry, stream->vec3(entry));
    }
}

}  // namespace

bool inbetween(const Pool& pool, std::span<const float> weights, const Vertices& out) {
    const auto too_short = [&](const auto& span) { return !span.empty() && span.size() < pool.vertices; };
    if (too_short(out.positions) || too_short(out.normals) || too_short(out.tangents)) return false;
    if (weights.size() < pool.targets.size()) return false;

    fill<glm::vec3>(pool.positions, pool.vertices, out.positions);
    fill<glm::vec3>(pool.normals, pool.vertices, out.normals);
    fill<glm::vec4>(pool.tangents, pool.vertices, out.tangents);
    for (std::size_t k = 0; k < pool.targets.size(); ++k) {
        if (weights[k] == 0.0f) continue;
        const TargetView& target = pool.targets[k];
        displace(target, target.positions, weights[k], out.positions);
        if (pool.normals) displace(target, target.normals, weights[k], out.normals);
        if (pool.tangents) displace(target, target.tangents, weights[k], out.tangents);
    }
    return true;
}

}  // namespace bendy
