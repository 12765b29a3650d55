#pragma once

#include <bendy/format/packed_clip.h>
#include <bendy/runtime/transform.h>

#include "unpack_block.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

// Data for playing a packed clip on a model that is the same for all frames: built once, when the model is opened.
namespace bendy {

inline constexpr std::uint32_t kJointFloats = sizeof(JointTransform) / sizeof(float);

/// A constant track, including rest.
struct UnpackedConstant {
    std::uint32_t place = 0;   ///< floats from the first joint's transform to what the track sets
    std::uint32_t floats = 4;  ///< 4: a rotation; 3
    std::array<float, 4> value{};
};

/// PackedSegment, and the location of its windows.
struct UnpackSegment {
    std::uint64_t tables = 0;  ///< bytes from the payload's start
    std::uint64_t frames = 0;  ///< bytes from the payload's start
    std::uint64_t stride = 0;  ///< bytes of a frame
    std::size_t windows = 0;   ///< index of the first one
};

/// About 300 bytes per eight animated tracks, 100 per eight of them in each segment, and 24 per constant track.
struct UnpackPlan {
    const PackedView* packed = nullptr;
    std::vector<UnpackedConstant> constants;
    std::vector<UnpackGroup> groups;  ///< in the order of a frame's bits
    std::vector<UnpackSegment> segments;
    std::vector<UnpackWindows> windows;  ///< by segment, group, component
};

/// \param packed  must outlive the plan
/// \param rest    of the joints, as many as `packed` was read for
UnpackPlan make_unpack_plan(const PackedView& packed, std::span<const JointTransform> rest);

}  // namespace bendy
