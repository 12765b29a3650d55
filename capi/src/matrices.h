#pragma once

#include <bendy/runtime/palette_matrix.h>

#include <glm/gtc/type_ptr.hpp>
#include <glm/mat4x4.hpp>

#include <algorithm>
#include <cstddef>

// Matrices as C has them: 16 floats, column after column.
namespace bendy::capi {

inline constexpr std::size_t kMatrixNumbers = 16;  // per matrix

inline void put_matrix(const glm::mat4& matrix, float* out) {
    std::copy_n(glm::value_ptr(matrix), kMatrixNumbers, out);
}

/// Writes the rows of a 3x4 matrix as the columns of a 4x4 one.
inline void put_matrix(const PaletteMatrix& matrix, float* out) {
    for (int column = 0; column < 4; ++column) {
        for (const auto& row : matrix.rows) *out++ = row[column];
        *out++ = column == 3 ? 1.0f : 0.0f;
    }
}

}  // namespace bendy::capi
