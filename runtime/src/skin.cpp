#include <bendy/runtime/skin.h>

#include <bendy/runtime/inbetween.h>
#include <bendy/runtime/local_to_model.h>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <cassert>

namespace bendy {
namespace {

/// Zero stays zero.
glm::vec3 normalised(const glm::vec3& v) {
    const float length = glm::length(v);
    return length > 0.0f ? v / length : glm::vec3(0.0f);
}

/// The inverse transpose times |determinant|: the same direction, and defined for matrices without an inverse.
glm::mat3 normal_matrix(const glm::mat3& m, float determinant) {
    const glm::mat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    return determinant < 0.0f ? -cofactors : cofactors;
}

void transform_vertex(const glm::mat4& matrix, std::uint32_t vertex, const Vertices& out) {
    if (!out.positions.empty()) {
        glm::vec3& position = out.positions[vertex];
        position = glm::vec3(matrix * glm::vec4(position, 1.0f));
    }
    if (out.normals.empty() && out.tangents.empty()) return;
    const glm::mat3 linear(matrix);
    const float determinant = glm::determinant(linear);
    if (!out.normals.empty()) {
        glm::vec3& normal = out.normals[vertex];
        normal = normalised(normal_matrix(linear, determinant) * normal);
    }
    if (!out.tangents.empty()) {
        glm::vec4& tangent = out.tangents[vertex];
        // A mirrored surface turns its bitangent round.
        tangent = glm::vec4(normalised(linear * glm::vec3(tangent)), determinant < 0.0f ? -tangent.w : tangent.w);
    }
}

/// sum(w_i M_i) of one vertex.
glm::mat4 blend(const Pool& pool, std::span<const glm::mat4> palette, std::uint32_t vertex) {
    glm::mat4 sum(0.0f);
    for (std::uint32_t k = 0; k < pool.weights->components; ++k) {
        const float weight = pool.weights->number(vertex, k);
        if (weight != 0.0f) sum += weight * palette[pool.bones->index(vertex, k)];
    }
    return sum;
}

}  // namespace

/// The work on a pose's scratch memory.
class Skinning {
public:
    /// The first `vertices` of a pool.
    static bool skin_pool(const Model& model, std::uint32_t pool_number, Pose& pose, std::uint32_t vertices,
                          const Vertices& out);
    /// Of all pools, each at its place; vertices_of(pool): how many of its first.
    template <class Count>
    static bool skin_all(const Model& model, Pose& pose, const Count& vertices_of, const Vertices& out);
};

bool Skinning::skin_pool(const Model& model, std::uint32_t pool_number, Pose& pose, std::uint32_t vertices,
                         const Vertices& out) {
    assert(&model == &pose.model() && pool_number < model.pools().size());
    const Pool& pool = model.pools()[pool_number];
    const auto weights = std::span(pose.target_weights_).subspan(model.first_target(pool_number), pool.targets.size());
    if (!inbetween(pool, weights, vertices, out)) return false;
    if (pose.is_stale()) local_to_model(pose);

    if (pool.is_rigid()) {
        for (std::uint32_t vertex = 0; vertex < vertices; ++vertex) {
            const std::uint32_t joint = model.rigid_mover(pool_number, vertex);
            if (joint != kNone) transform_vertex(pose.model_space_[joint], vertex, out);
        }
        return true;
    }
    const auto palette = std::span(pose.palette_).first(pool.palette.joints.size());
    const auto inverse_bind = pool.palette.inverse_bind();
    for (std::size_t entry = 0; entry < palette.size(); ++entry) {
        // Large translations cancel here, which a product of floats would not survive.
        const glm::dmat4 matrix = pose.exact_model_space_[pool.palette.joints[entry]] * glm::dmat4(inverse_bind[entry]);
        palette[entry] = glm::mat4(matrix);
    }
    for (std::uint32_t vertex = 0; vertex < vertices; ++vertex) {
        transform_vertex(blend(pool, palette, vertex), vertex, out);
    }
    return true;
}

template <class Count>
bool Skinning::skin_all(const Model& model, Pose& pose, const Count& vertices_of, const Vertices& out) {
    const auto fits = [&](const auto& span) { return span.empty() || span.size() >= model.vertex_count(); };
    if (!fits(out.positions) || !fits(out.normals) || !fits(out.tangents)) return false;
    const auto part = [](const auto& span, std::uint64_t first, std::uint64_t count) {
        return span.empty() ? span : span.subspan(first, count);
    };
    for (std::uint32_t pool = 0; pool < model.pools().size(); ++pool) {
        const std::uint64_t first = model.first_vertex(pool);
        const std::uint32_t count = vertices_of(pool);
        if (count == 0) continue;
        skin_pool(
            model, pool, pose, count,
            {part(out.positions, first, count), part(out.normals, first, count), part(out.tangents, first, count)});
    }
    return true;
}

bool skin(const Model& model, std::uint32_t pool, Pose& pose, const Vertices& out) {
    return Skinning::skin_pool(model, pool, pose, model.pools()[pool].vertices, out);
}

bool skin(const Model& model, Pose& pose, const Vertices& out) {
    return Skinning::skin_all(
        model, pose, [&](std::uint32_t pool) { return model.pools()[pool].vertices; }, out);
}

bool skin(const Model& model, std::uint32_t pool, Pose& pose, const Lod& lod, const Vertices& out) {
    return Skinning::skin_pool(model, pool, pose, lod.vertices(pool), out);
}

bool skin(const Model& model, Pose& pose, const Lod& lod, const Vertices& out) {
    return Skinning::skin_all(
        model, pose, [&](std::uint32_t pool) { return lod.vertices(pool); }, out);
}

}  // namespace bendy
