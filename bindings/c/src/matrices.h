#pragma once

#include <bendy/runtime/palette_matrix.h>

#include <glm/gtc/type_ptr.hpp>
#include <glm/mat4x4.hpp>

#include <algorithm>
#include <cstddef>

// C's form of matrices: 16 floats, column by column.
namespace bendy::capi {

inline constexpr std::size_t kMatrixNumbers = 16;  // per matrix

inline void put_matrix(const glm::mat4& matrix, float* out) {
    std::copy_n(glm::value_ptr(matrix), kMatrixNumbers, out);
}

/// Writes the rows of a 3x4 matrix as the columns of a 4x4 one.
inline void put_matrix(const PaletteMatrix& matrix, float* out) {
    const auto& [x, y, z] = matrix.rows;
    const float columns[kMatrixNumbers] = {x[0], y[0], z[0], 0.0f, x[1], y[1], z[1], 0.0f,
                                           x[2], y[2], z[2], 0.0f, x[3], y[3], z[3], 1.0f};
    std::copy_n(columns, kMatrixNumbers, out);
}

}  // namespace bendy::capi
