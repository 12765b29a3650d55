#pragma once

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

namespace bendy {

/// Returns the matrix's axes made orthonormal and right-handed, x first; an axis of zero length is replaced.
inline glm::dmat3 rigid_axes(const glm::dmat3& matrix) {
    constexpr double kShort = 1e-9;  // relative to the longest axis
    glm::dmat3 axes = glm::determinant(matrix) < 0.0 ? -matrix : matrix;
    const auto across = [](const glm::dvec3& v) {
        const bool is_near_x = v.x * v.x > 0.5 * glm::dot(v, v);
        return glm::normalize(glm::cross(v, is_near_x ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0)));
    };
    const double longest = glm::max(glm::length(axes[0]), glm::max(glm::length(axes[1]), glm::length(axes[2])));
    if (!(longest > 0.0)) return glm::dmat3(1.0);
    if (glm::length(axes[0]) > kShort * longest) {
        axes[0] = glm::normalize(axes[0]);
        axes[1] -= glm::dot(axes[0], axes[1]) * axes[0];
        axes[1] = glm::length(axes[1]) > kShort * longest ? glm::normalize(axes[1]) : across(axes[0]);
    } else {
        axes[1] = glm::length(axes[1]) > kShort * longest ? glm::normalize(axes[1]) : across(axes[2]);
        axes[0] = glm::cross(axes[1], axes[2]);
        axes[0] = glm::length(axes[0]) > kShort * longest ? glm::normalize(axes[0]) : across(axes[1]);
    }
    axes[2] = glm::cross(axes[0], axes[1]);
    return axes;
}

/// Returns a transform without its scale, shear and mirroring.
inline glm::dmat4 rigid_part(const glm::dmat4& matrix) {
    glm::dmat4 rigid(rigid_axes(glm::dmat3(matrix)));
    rigid[3] = matrix[3];
    return rigid;
}

inline glm::dquat rigid_rotation(const glm::dmat4& matrix) {
    return glm::normalize(glm::quat_cast(rigid_axes(glm::dmat3(matrix))));
}

}  // namespace bendy
