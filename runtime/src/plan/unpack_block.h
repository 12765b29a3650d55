#pragma once

#include <cstddef>
#include <cstdint>

// Input and output of the packed clip kernels: plain data only, as in skin_block.h.
namespace bendy {

/// Up to eight animated tracks that are stored together in each frame, one per lane. Lanes beyond `count` decode to
/// arbitrary values.
struct UnpackGroup {
    static constexpr std::uint32_t kLanes = 8;
    float rest[4][kLanes]{};         ///< rotation: x y z w, unit; otherwise three numbers
    float steps[3][kLanes]{};        ///< by component; 0 beyond `count`
    std::uint32_t places[kLanes]{};  ///< floats from the first block to the joint's first number; see sample_block.h
    bool is_rotation = true;
    std::uint32_t count = 0;       ///< tracks
    std::uint32_t components = 3;  ///< 1 or 3
    std::uint32_t bases = 0;       ///< bytes from the segment's tables to the first component's first base
    std::uint32_t stride = 0;      ///< bytes from there to the next component's
    std::uint32_t base_bytes = 2;  ///< 2 or 4
    std::uint32_t parts = 0;       ///< blocks of joints that it sets
};

/// The lanes of a block of joints that a group sets.
struct UnpackPart {
    std::int32_t lanes[UnpackGroup::kLanes]{};        ///< of the group, by lane of the block; 0 where it has none
    std::int32_t is_animated[UnpackGroup::kLanes]{};  ///< -1: the group has a track for the lane; 0
    std::uint32_t place = 0;                          ///< floats from the first block to the property's first number
};

/// The location of one component of a group in the frames of a segment: four numbers in each of two windows of sixteen
/// bytes. In each lane the number is the 32 bits from byte `bytes` of its window on, shifted left and then right.
struct UnpackWindows {
    std::uint32_t low = 0;  ///< bytes from the frame's start to the window of lanes 0 to 3
    std::uint32_t high = 0;
    std::uint8_t bytes[UnpackGroup::kLanes]{};
    std::uint8_t left[UnpackGroup::kLanes]{};
    std::uint8_t right[UnpackGroup::kLanes]{};  ///< 32: the number has no bits
};

/// A packed clip at one moment.
struct UnpackBlock {
    const UnpackGroup* groups;
    std::size_t group_count;
    const UnpackPart* parts;       ///< by group; kernels of four lanes use the places
    const UnpackWindows* windows;  ///< by group, then component
    const unsigned char* tables;
    const unsigned char* left;   ///< the left frame
    const unsigned char* right;  ///< the right frame; at the end, the same as left
    const unsigned char* end;    ///< of the payload
    float fraction;
    bool is_near_end;  ///< reading kReadPast bytes beyond a frame or a table could leave the payload
    float* local;      ///< blocks of joints
    static constexpr std::size_t kReadPast = 32;
    static constexpr float kMaxHalfTurnSquare = 10.89f;  ///< of a rotation vector
};

}  // namespace bendy
