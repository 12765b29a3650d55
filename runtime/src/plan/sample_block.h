#pragma once

#include <cstddef>
#include <cstdint>

// Input and output of the sampling and blending kernels: plain data only, as in skin_block.h.
namespace bendy {

// Where a JointBlock has its numbers, in floats.
inline constexpr std::uint32_t kBlockJoints = 8;  ///< of a block; one number of all of them
inline constexpr std::uint32_t kRotation = 0;
inline constexpr std::uint32_t kTranslation = 4 * kBlockJoints;
inline constexpr std::uint32_t kScale = 7 * kBlockJoints;
inline constexpr std::uint32_t kBlockFloats = 10 * kBlockJoints;

inline constexpr std::uint32_t kAllBits = 0xffff'ffff;  ///< of a mask

/// Tracks on the same time line that animate one property of the joints of a block, a lane for each joint.
struct TrackGroup {
    const float* keys[kBlockJoints];        ///< of a lane without a track, those of another one; see SampleBlock
    std::uint32_t has_track[kBlockJoints];  ///< kAllBits, or 0
    std::uint32_t count;                    ///< tracks
    std::uint32_t place;                    ///< floats from the first block to the property
};

/// A track of translations or scales.
struct VectorTrack {
    const float* keys;    ///< see SampleBlock
    std::uint32_t place;  ///< floats from the first block to the joint's first number
};

/// Tracks of one interpolation between key `left` and the next one; all of them have both keys. A key is four numbers
/// for a rotation and three for a vector; of a cubic track an in-tangent, a value and an out-tangent.
struct SampleBlock {
    const TrackGroup* rotations;
    std::size_t rotation_groups;
    const TrackGroup* vectors;
    std::size_t vector_groups;
    const VectorTrack* tracks;  ///< more vectors, one by one
    std::size_t track_count;
    std::size_t left;
    float fraction;  ///< 0 to 1
    float seconds;   ///< from `left` to the next key; for cubic tracks only
    float* local;    ///< blocks of joints
};

/// Blends transforms into others, joint by joint.
struct BlendBlock {
    std::size_t joints;
    float* local;        ///< blocks of joints
    const float* other;  ///< as local
    float weight;
    const float* mask;  ///< one per joint; null: 1
};

}  // namespace bendy
