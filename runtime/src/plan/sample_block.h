#pragma once

#include <cstddef>
#include <cstdint>

// Input and output of the sampling kernels: plain data only, as in skin_block.h.
namespace bendy {

/// Up to eight rotation tracks on the same time line. Unused entries repeat the last one.
struct RotationTracks {
    static constexpr std::size_t kMost = 8;
    const float* keys[kMost];     // arrays, since kernels read them; four numbers per key
    std::uint32_t places[kMost];  ///< floats from the first joint's transform to the rotation
};

/// A track of translations or scales.
struct VectorTrack {
    const float* keys;    ///< three numbers per key; of a cubic track three times as many, see SampleBlock
    std::uint32_t place;  ///< floats from the first joint's transform
};

/// Tracks of one interpolation between key `left` and the next one; all of them have both keys. A key of a cubic track
/// is an in-tangent, a value and an out-tangent.
struct SampleBlock {
    const RotationTracks* rotations;
    std::size_t rotation_groups;
    const VectorTrack* vectors;
    std::size_t vector_tracks;
    std::size_t left;
    float fraction;  ///< 0 to 1
    float seconds;   ///< from `left` to the next key
    float* local;    ///< ten per joint
};

/// Blends transforms into others, joint by joint.
struct BlendBlock {
    std::size_t joints;
    float* local;        ///< ten per joint: rotation x y z w, translation, scale; room for a last whole group
    const float* other;  ///< as local
    float weight;
    const float* mask;  ///< one per joint; null: 1
};

}  // namespace bendy
