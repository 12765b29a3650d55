#pragma once

#include <bendy/runtime/palette_matrix.h>

#include <glm/mat4x4.hpp>

namespace bendy {

/// Returns the upper three rows as floats.
inline PaletteMatrix to_rows(const glm::dmat4& matrix) {
    PaletteMatrix entry{};
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) entry.rows[row][column] = static_cast<float>(matrix[column][row]);
    }
    return entry;
}

}  // namespace bendy
