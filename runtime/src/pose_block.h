#pragma once

#include <bendy/runtime/palette_matrix.h>

#include <cstddef>
#include <cstdint>

// What the kernels for joint matrices work on: plain numbers only, as in skin_block.h.
namespace bendy {

struct PoseBlock {
    std::size_t joints;
    const float* local;            ///< ten a joint: rotation x y z w, translation, scale; no shear
    const std::uint32_t* parents;  ///< smaller than the joint's own number, or 2^32 - 1
    double* exact;                 ///< sixteen a joint, columns: joint space to model space
    float* model;                  ///< the same, rounded
};

struct PaletteBlock {
    std::size_t entries;
    const double* exact;          ///< as above
    const std::uint32_t* joints;  ///< of each entry
    const double* inverse_bind;   ///< sixteen an entry, columns
    PaletteMatrix* palette;
};

/// What local_to_model does, within a few units in the last place of doubles.
void pose_avx2(const PoseBlock& block);

/// exact * inverse_bind of each entry. Whether all numbers are finite.
bool palette_avx2(const PaletteBlock& block);

}  // namespace bendy
