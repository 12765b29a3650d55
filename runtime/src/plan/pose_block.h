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

/// Poses of one model, a lane for each.
struct PosesBlock {
    static constexpr std::size_t kPoses = 8;

    std::size_t joints;
    const float* local[kPoses];  ///< as in PoseBlock; may be the same one several times
    const std::uint32_t* parents;
    float* model;  ///< kMatrixLanes per joint: the upper three rows of joint space to model space, number by number
};

inline constexpr std::size_t kMatrixLanes = 12 * PosesBlock::kPoses;  ///< numbers of one joint in PosesBlock::model

struct PaletteBlock {
    std::size_t entries;
    const float* model;           ///< as above
    const std::uint32_t* joints;  ///< of each entry
    const PaletteMatrix* inverse_bind;
    PaletteMatrix* palette;
};

/// The palettes of the poses in a PosesBlock.
struct PalettesBlock {
    std::size_t entries;
    const float* model;                          ///< of a PosesBlock
    const std::uint32_t* joints;                 ///< of each entry
    const PaletteMatrix* inverse_bind;           ///< null: the joints' own matrices
    PaletteMatrix* palette[PosesBlock::kPoses];  ///< of each pose; the same one where the poses are the same
};

}  // namespace bendy
