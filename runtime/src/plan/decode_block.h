#pragma once

#include <cstddef>
#include <cstdint>

// Input and output of the kernels that decode the streams of compact files: plain data only, as in skin_block.h.
namespace bendy {

struct Integers {
    const void* data;  ///< aligned to their size only
    std::uint32_t bytes;
    bool is_signed;  ///< of one or two bytes; those of four are unsigned
};

/// Numbers in boxes: minimum + step * integer.
struct BoxedBlock {
    static constexpr std::size_t kPattern = 24;  ///< a multiple of all vectors' components and all kernels' lanes

    Integers integers;
    std::size_t numbers;
    float minimum[kPattern], step[kPattern];  ///< of the first numbers, and so on
    float* to;
};

/// Unit vectors from points of the unfolded octahedron: see decode_octahedral.
struct DirectionsBlock {
    Integers integers;  ///< signed, of one or two bytes
    std::size_t count;
    std::size_t width;  ///< integers of an element: 2; or 3, with a handedness
    float* to;          ///< x y z of each element, and its handedness
};

}  // namespace bendy
