#pragma once

#include <cstddef>
#include <cstdint>

// What the kernels for sampling work on: plain numbers only, as in skin_block.h.
namespace bendy {

/// Up to eight rotation tracks with one time line. Places past the last one repeat it.
struct RotationTracks {
    static constexpr std::size_t kMost = 8;
    const float* keys[kMost];     // arrays, since kernels read them; four numbers a key
    std::uint32_t places[kMost];  ///< floats from the first joint's transform to the rotation
};

/// A track of translations or scales.
struct VectorTrack {
    const float* keys;    ///< three numbers a key
    std::uint32_t place;  ///< floats from the first joint's transform
};

/// Linear tracks between key `left` and the next one, which all of them have.
struct SampleBlock {
    const RotationTracks* rotations;
    std::size_t rotation_groups;
    const VectorTrack* vectors;
    std::size_t vector_tracks;
    std::size_t left;
    float fraction;  ///< 0 to 1
    float* local;    ///< ten a joint
};

/// Mixes transforms into others, joint by joint.
struct BlendBlock {
    std::size_t joints;
    float* local;        ///< ten a joint: rotation x y z w, translation, scale
    const float* other;  ///< as local
    float weight;
    const float* mask;  ///< one a joint; null: 1
};

}  // namespace bendy
