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
    std::uint32_t places[kLanes]{};  ///< floats from the first block of joints to the property's first number
    bool is_rotation = true;
    std::uint32_t count = 0;       ///< tracks
    std::uint32_t components = 3;  ///< 1 or 3
    std::uint32_t bases = 0;       ///< bytes from the segment's tables to the first component's first base
    std::uint32_t stride = 0;      ///< bytes from there to the next component's
    std::uint32_t base_bytes = 2;  ///< 2 or 4
    std::uint32_t parts = 0;       ///< blocks of joints that the tracks animate
};

/// The tracks of a group that animate joints of one block.
struct UnpackPart {
    std::int32_t lanes[UnpackGroup::kLanes];       ///< for each joint of the block, the group's lane with its track
    std::uint32_t has_track[UnpackGroup::kLanes];  ///< kAllBits, or 0
    std::uint32_t place;                           ///< floats from the first block to the property
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
    const UnpackPart* parts;       ///< by group
    const UnpackWindows* windows;  ///< by group, then component
    const unsigned char* tables;
    const unsigned char* left;   ///< the left frame
    const unsigned char* right;  ///< the right frame; at the end, the same as left
    const unsigned char* end;    ///< of the payload
    float fraction;
    bool is_near_end;  ///< reading kReadPast bytes beyond a frame or a table could leave the payload
    float* local;      ///< blocks of joints; at rest where a track animates
    static constexpr std::size_t kReadPast = 32;
    static constexpr float kMaxHalfTurnSquare = 10.89f;  ///< of a rotation vector
};

}  // namespace bendy
