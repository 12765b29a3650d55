#pragma once

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "plan/blocks.h"

#include <cstddef>
#include <span>

// Skinning in doubles, one vertex at a time: the reference for the kernels.
namespace bendy {

/// By matrices.
SkinKernel skin_plain;

/// A palette entry for skinning by dual quaternions: v -> rigid motion of (stretch * v + shift).
struct StretchedMotion {
    glm::dquat real{1.0, 0.0, 0.0, 0.0};  ///< real part of the rigid motion as a dual quaternion; unit
    glm::dquat dual{0.0, 0.0, 0.0, 0.0};
    glm::dmat3 stretch{1.0};
    glm::dvec3 shift{0.0};
};

/// By dual quaternions. `scale` applies to everything; `is_stretched`: not all stretches of the motions are 1.
void dual_plain(const SkinBlock& block, std::span<const StretchedMotion> motions, double scale, bool is_stretched);

// How both read a vertex and write it to the caller's memory.

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

}  // namespace bendy
