#pragma once

#include <bendy/format/public.h>
#include <bendy/runtime/palette_matrix.h>

#include <cstddef>
#include <cstdint>

// Input and output of the skinning kernels. Plain data only, since kernels are compiled for other processors than the
// rest of the program: they must not emit inline functions of a shared header.
namespace bendy {

/// The destination of one attribute: the numbers of vertex v are at data[v * stride]. Null: not wanted.
struct SkinOutput {
    float* data;
    std::size_t stride;  ///< floats, at least the number of components
};

/// A range of a mesh's vertices. All pointers are aligned to their element type only, and nothing beyond the last
/// vertex is read or written.
struct SkinBlock {
    std::size_t vertices;
    const PaletteMatrix* palette;  ///< finite
    const std::uint8_t* bones8;    ///< influences per vertex; less than the palette's size
    const std::uint16_t* bones16;  ///< used instead of bones8; both null: palette[0] moves all vertices
    const float* weights;          ///< same layout as bones
    std::size_t influences;
    /// Null, or for each group of eight vertices, the index of its first bone in plan_bones; one more than groups. A
    /// group without bones there uses the arrays above. Ignored by kernels of four lanes.
    const std::uint32_t* plan_first;
    const std::uint16_t* plan_bones;
    const float* plan_weights;  ///< eight for each of plan_bones, 32-byte aligned
    const float* positions;     ///< 3 per vertex; not null if the output is wanted
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

/// In double precision, one vertex at a time.
SkinKernel skin_plain;
/// Within 8 units in the last place of the largest product that contributes to a number (relative to unit length, for
/// normals and tangents that do not cancel).
SkinKernel skin_sse4;
SkinKernel skin_avx2;
SkinKernel skin_neon;
SkinKernel skin_wasm;

/// The plain version is dual_plain.
DualKernel dual_sse4;
DualKernel dual_avx2;
DualKernel dual_neon;
DualKernel dual_wasm;

/// A number of vertices that exceeds the caches.
inline constexpr std::size_t kManyVertices = std::size_t{1} << 18u;

}  // namespace bendy
