#pragma once

#include <bendy/runtime/palette_matrix.h>

#include <cstddef>
#include <cstdint>

// What skinning kernels work on. Nothing but plain numbers, since kernels are compiled for other processors than the
// rest of the program: no inline function of a shared header may come out of them.
namespace bendy {

/// Where one attribute is written: vertex v's numbers at data[v * stride]. Null: not wanted.
struct SkinOutput {
    float* data;
    std::size_t stride;  ///< floats, at least the attribute's own
};

/// Some vertices of a mesh. All pointers are aligned to their numbers only, and nothing behind the last vertex is read
/// or written.
struct SkinBlock {
    std::size_t vertices;
    const PaletteMatrix* palette;  ///< finite
    const std::uint8_t* bones8;    ///< influences per vertex, below the palette's size
    const std::uint16_t* bones16;  ///< instead; both null: palette[0] moves all
    const float* weights;          ///< as bones
    std::size_t influences;
    /// Or null: for each group of eight vertices, where its bones begin in plan_bones; one more than groups. A group
    /// without any goes by the lists above. Kernels of four lanes do not look at it.
    const std::uint32_t* plan_first;
    const std::uint16_t* plan_bones;
    const float* plan_weights;  ///< eight for each of plan_bones, on 32 bytes
    const float* positions;     ///< 3 per vertex; not null where the output is wanted
    const float* normals;       ///< 3 per vertex
    const float* tangents;      ///< 4 per vertex
    SkinOutput out_positions, out_normals, out_tangents;
    bool streams;  ///< the output is large: write past the caches where its alignment allows
};

/// A rigid motion as a unit dual quaternion; each part is x y z w.
struct DualMotion {
    float real[4], dual[4];
};

/// Vertices for skinning by dual quaternions: v -> scale * (blended motion of (blended stretch of v)).
struct DualBlock {
    SkinBlock vertices;         ///< with bones and weights; `palette`: the stretches, null if nothing is stretched
    const DualMotion* motions;  ///< finite
    float scale;
};

using SkinKernel = void(const SkinBlock& block);
using DualKernel = void(const DualBlock& block);

/// In double precision, one vertex after another.
SkinKernel skin_plain;
/// Within 8 units in the last place of the largest product that goes into a number (of the unit length, in normals and
/// tangents that do not cancel).
SkinKernel skin_sse4;
SkinKernel skin_avx2;
SkinKernel skin_neon;
SkinKernel skin_wasm;

/// The plain one is dual_plain.
DualKernel dual_sse4;
DualKernel dual_avx2;
DualKernel dual_neon;
DualKernel dual_wasm;

/// So many vertices are more than the caches hold.
inline constexpr std::size_t kManyVertices = std::size_t{1} << 18u;

}  // namespace bendy
