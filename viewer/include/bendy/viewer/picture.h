#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace bendy::viewer {

/// Pixels from the top left, row after row: red, green, blue, alpha; sRGB, alpha straight.
struct Picture {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::uint8_t> pixels;  ///< 4 * width * height

    [[nodiscard]] std::size_t row_size() const { return std::size_t{4} * width; }
};

}  // namespace bendy::viewer
