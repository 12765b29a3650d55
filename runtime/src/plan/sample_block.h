#pragma once

#include <cstddef>
#include <cstdint>

// Input and output of the kernels that sample and blend: plain data only, as in skin_block.h. Transforms are in blocks
// of eight joints, 32-byte aligned: for each of ten numbers (rotation x y z w, translation, scale) eight floats in a
// row.
namespace bendy {

inline constexpr std::uint32_t kBlockJoints = 8;
inline constexpr std::uint32_t kBlockFloats = 10 * kBlockJoints;

/// A moment between key `left` of a track and the next one; both exist.
struct SampleMoment {
    std::uint32_t left;
    float fraction;  ///< 0 to 1
};

/// The linear tracks of one property of the eight joints of a block. Lanes without a track repeat another lane's.
struct TrackGroup {
    const float* keys[kBlockJoints];         // arrays, since kernels read them; three or four numbers per key
    std::uint32_t moments[kBlockJoints];     ///< indices into SampleBlock::moments
    std::int32_t is_animated[kBlockJoints];  ///< -1: the lane has a track; 0
    std::uint32_t place;                     ///< floats from the first block to the property's first number
    bool is_full;                            ///< all lanes have a track
    bool is_one_moment;                      ///< of all lanes
};

/// A track of translations or scales whose block has few others.
struct VectorTrack {
    const float* keys;     ///< three numbers per key
    std::uint32_t place;   ///< floats from the first block to the joint's first number
    std::uint32_t moment;  ///< index into SampleBlock::moments
};

struct SampleBlock {
    const TrackGroup* rotations;
    std::size_t rotation_groups;
    const TrackGroup* vectors;
    std::size_t vector_groups;
    const VectorTrack* tracks;
    std::size_t track_count;
    const SampleMoment* moments;
    float* local;  ///< blocks of joints
};

/// Blends transforms into others, joint by joint.
struct BlendBlock {
    std::size_t joints;
    float* local;        ///< blocks of joints; those after the last joint are kept
    const float* other;  ///< as local
    float weight;
    const float* mask;  ///< one per joint; null: 1
};

}  // namespace bendy
