#include "plain.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

namespace bendy {
namespace {

/// The inverse transpose times |determinant|: the same direction, and also defined for singular matrices.
glm::dmat3 normal_matrix(const glm::dmat3& m, double determinant) {
    const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    return determinant < 0.0 ? -cofactors : cofactors;
}

/// Returns sum(w_i M_i) for one vertex.
glm::dmat4x3 blend(const SkinBlock& block, std::size_t vertex) {
    glm::dmat4x3 sum(0.0);
    const bool is_rigid = block.bones8 == nullptr && block.bones16 == nullptr;
    const std::size_t influences = is_rigid ? 1 : block.influences;
    for (std::size_t k = 0; k < influences; ++k) {
        const std::size_t at = vertex * influences + k;
        const double weight = is_rigid ? 1.0 : double{block.weights[at]};
        if (weight == 0.0) continue;
        std::size_t bone = 0;
        if (block.bones8 != nullptr) bone = block.bones8[at];
        if (block.bones16 != nullptr) bone = block.bones16[at];
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 4; ++column)
                sum[column][row] += weight * double{block.palette[bone].rows[row][column]};
        }
    }
    return sum;
}

}  // namespace

void skin_plain(const SkinBlock& block) {
    for (std::size_t vertex = 0; vertex < block.vertices; ++vertex) {
        const glm::dmat4x3 matrix = blend(block, vertex);
        if (block.out_positions.data != nullptr)
            put(block.out_positions, vertex, matrix * glm::dvec4(vec3_at(block.positions + 3 * vertex), 1.0));
        if (block.out_normals.data == nullptr && block.out_tangents.data == nullptr) continue;
        const glm::dmat3 linear(matrix);
        const double determinant = glm::determinant(linear);
        if (block.out_normals.data != nullptr) {
            const glm::dvec3 normal = vec3_at(block.normals + 3 * vertex);
            put(block.out_normals, vertex, unit_or_zero(normal_matrix(linear, determinant) * normal));
        }
        if (block.out_tangents.data != nullptr) {
            const float* const tangent = block.tangents + 4 * vertex;
            put(block.out_tangents, vertex, unit_or_zero(linear * vec3_at(tangent)));
            // Mirroring flips the bitangent.
            block.out_tangents.data[vertex * block.out_tangents.stride + 3] =
                determinant < 0.0 ? -tangent[3] : tangent[3];
        }
    }
}

}  // namespace bendy
