#pragma once

#include <bendy/format/packed_clip.h>
#include <bendy/runtime/transform.h>

#include "blocks.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

// Data for playing a packed clip on a model that is the same for all frames: built once, when the model is opened.
namespace bendy {

/// PackedSegment, and the location of its windows.
struct UnpackSegment {
    std::uint64_t tables = 0;  ///< bytes from the payload's start
    std::uint64_t frames = 0;  ///< bytes from the payload's start
    std::uint64_t stride = 0;  ///< bytes of a frame
    std::size_t windows = 0;   ///< index of the first one
};

/// About 500 bytes per eight animated tracks, 100 per eight of them in each segment, and 40 per joint.
struct UnpackPlan {
    const PackedView* packed = nullptr;
    std::vector<JointBlock> start;    ///< the joints at rest, with the constant tracks
    std::vector<UnpackGroup> groups;  ///< in the order of a frame's bits
    std::vector<UnpackPart> parts;    ///< by group
    std::vector<UnpackSegment> segments;
    std::vector<UnpackWindows> windows;  ///< by segment, group, component
};

/// \param packed  must outlive the plan
/// \param rest    of the joints, as many as `packed` was read for
UnpackPlan make_unpack_plan(const PackedView& packed, std::span<const JointTransform> rest);

/// Sets one track's value at a joint that is at rest, in double precision.
/// \param u  [0, 1), from the group's left numbers to its right ones
void set_unpacked(const PackedGroup& group, std::uint32_t track, double u, JointTransform& joint);

}  // namespace bendy
