#pragma once

#include "skin_block.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <cstddef>

// Reads a vertex from a SkinBlock and writes it to the caller's memory, in doubles: shared by the plain skinning
// functions.
namespace bendy {

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
