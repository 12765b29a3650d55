#pragma once

#include "plan/blocks.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x3.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstddef>

// Skinning by matrices in doubles, one vertex at a time: the judge of the kernels. It shares no code with them, and
// leaves out bones whose weight is zero.
namespace bendy::test {

inline glm::dvec3 vec3_at(const float* from) {
    return {from[0], from[1], from[2]};
}

inline void put(const SkinOutput& out, std::size_t vertex, const glm::dvec3& v) {
    for (int c = 0; c < 3; ++c) out.data[vertex * out.stride + static_cast<std::size_t>(c)] = static_cast<float>(v[c]);
}

/// Normalises; zero stays zero.
inline glm::dvec3 unit_or_zero(const glm::dvec3& v) {
    const double length = glm::length(v);
    return length > 0.0 ? v / length : glm::dvec3(0.0);
}

/// The inverse transpose times |determinant|: the same direction, and also defined for singular matrices.
inline glm::dmat3 normal_matrix(const glm::dmat3& m, double determinant) {
    const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    return determinant < 0.0 ? -cofactors : cofactors;
}

/// Returns sum(w_i M_i) for one vertex.
inline glm::dmat4x3 blended_matrix(const SkinBlock& block, std::size_t vertex) {
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

/// Writes a vertex that is moved by one matrix.
inline void write_moved(const SkinBlock& block, std::size_t vertex, const glm::dmat4x3& matrix) {
    if (block.out_positions.data != nullptr)
        put(block.out_positions, vertex, matrix * glm::dvec4(vec3_at(block.positions + 3 * vertex), 1.0));
    if (block.out_normals.data == nullptr && block.out_tangents.data == nullptr) return;
    const glm::dmat3 linear(matrix);
    const double determinant = glm::determinant(linear);
    if (block.out_normals.data != nullptr) {
        const glm::dvec3 normal = vec3_at(block.normals + 3 * vertex);
        put(block.out_normals, vertex, unit_or_zero(normal_matrix(linear, determinant) * normal));
    }
    if (block.out_tangents.data == nullptr) return;
    const float* const tangent = block.tangents + 4 * vertex;
    put(block.out_tangents, vertex, unit_or_zero(linear * vec3_at(tangent)));
    // Mirroring flips the bitangent.
    block.out_tangents.data[vertex * block.out_tangents.stride + 3] = determinant < 0.0 ? -tangent[3] : tangent[3];
}

inline void skin_in_doubles(const SkinBlock& block) {
    for (std::size_t vertex = 0; vertex < block.vertices; ++vertex)
        write_moved(block, vertex, blended_matrix(block, vertex));
}

}  // namespace bendy::test
