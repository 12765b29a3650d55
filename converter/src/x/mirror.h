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

/// S * M * S with S = diag(1, 1, -1, 1): what leads from Z to elsewhere, or to Z, changes its sign.
inline std::array<double, 16> mirrored(std::array<double, 16> matrix) {
    for (const std::size_t element : {2u, 6u, 8u, 9u, 11u, 14u}) matrix[element] = 0.0 - matrix[element];
    return matrix;
}

}  // namespace bendy::converter::x
