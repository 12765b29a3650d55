#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>

// X-files are left-handed, Z into the screen; a Scene is right-handed. Both readers and writers mirror along Z. A zero
// stays a positive zero.
namespace bendy::converter::x {

inline glm::vec3 mirrored(const glm::vec3& vector) {
    return {vector.x, vector.y, 0.0f - vector.z};
}

/// S * M * S of an affine matrix: what mixes Z with X and Y changes its sign, and so does the way along Z.
inline std::array<double, 16> mirrored(std::array<double, 16> matrix) {
    for (const std::size_t element : {2u, 6u, 8u, 9u, 14u}) matrix[element] = 0.0 - matrix[element];
    return matrix;
}

}  // namespace bendy::converter::x
