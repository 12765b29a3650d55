#pragma once

#include <bendy/runtime/palette_matrix.h>

#include <cstddef>
#include <cstdint>

// Input and output of the joint matrix kernels: plain data only, as in skin_block.h.
namespace bendy {

struct PoseBlock {
    std::size_t joints;
    const float* local;            ///< blocks of joints, as in sample_block.h; no shear
    const std::uint32_t* parents;  ///< of each joint; 2^32 - 1: a root
    const std::uint32_t* order;    ///< all joints, parents before children; neighbours are not ancestors of one another
    float* model;                  ///< sixteen per joint, column-major: joint space to model space; for whole blocks
};

struct PaletteBlock {
    std::size_t entries;
    const float* model;           ///< as above
    const std::uint32_t* joints;  ///< of each entry
    const PaletteMatrix* inverse_bind;
    PaletteMatrix* palette;
};

}  // namespace bendy
