#pragma once

#include <bendy/runtime/palette_matrix.h>

#include <cstddef>
#include <cstdint>

// What the kernels for joint matrices work on: plain numbers only, as in skin_block.h.
namespace bendy {

struct PoseBlock {
    std::size_t joints;
    const float* local;            ///< ten a joint: rotation x y z w, translation, scale; no shear
    const std::uint32_t* parents;  ///< of each joint; 2^32 - 1: a root
    const std::uint32_t* order;    ///< all joints, parents before children, a joint's neighbours not of its own line
    float* model;                  ///< sixteen a joint, columns: joint space to model space
};

struct PaletteBlock {
    std::size_t entries;
    const float* model;           ///< as above
    const std::uint32_t* joints;  ///< of each entry
    const PaletteMatrix* inverse_bind;
    PaletteMatrix* palette;
};

}  // namespace bendy
