#pragma once

#include <bendy/format/packed_cycle.h>
#include <bendy/runtime/transform.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

// What playing a packed cycle on a model takes that no frame changes: made once, when the model is opened.
namespace bendy {

/// A track that never changes, rest included.
struct UnpackedConstant {
    std::uint32_t place = 0;   ///< floats from the first joint's transform to what the track sets
    std::uint32_t floats = 4;  ///< 4: a rotation; 3
    std::array<float, 4> value{};
};

/// Up to eight animated tracks that stand together in each frame, one in a lane. Lanes past `count` stand for the last
/// track's joint and decode to anything, so they are stored first.
struct UnpackGroup {
    using Lanes = std::array<float, kPackedGroup>;
    std::array<Lanes, 4> rest{};   ///< rotation: x y z w, unit; otherwise three numbers
    std::array<Lanes, 3> steps{};  ///< by component; 0 past `count`
    /// Floats from the first joint's transform to what the track animates.
    std::array<std::uint32_t, kPackedGroup> places{};
    TrackPath path = TrackPath::rotation;
    std::uint32_t count = 0;       ///< tracks
    std::uint32_t components = 3;  ///< 1 or 3
    std::uint32_t bases = 0;       ///< bytes from the segment's tables to the first component's first base
    std::uint32_t stride = 0;      ///< bytes from there to the next component's
    std::uint32_t base_bytes = 2;  ///< 2 or 4
};

/// Where one component of a group lies in the frames of a segment: four numbers in each of two windows of sixteen bytes.
/// Lane by lane a number is the 32 bits from byte `bytes` of its window on, shifted left and then right.
struct UnpackWindows {
    std::uint32_t low = 0;  ///< bytes from the frame's start to the window of lanes 0 to 3
    std::uint32_t high = 0;
    std::array<std::uint8_t, kPackedGroup> bytes{};
    std::array<std::uint8_t, kPackedGroup> left{};
    std::array<std::uint8_t, kPackedGroup> right{};  ///< 32: the number has no bits
};

/// PackedSegment, and where its windows are.
struct UnpackSegment {
    std::uint64_t tables = 0;  ///< bytes from the payload's start
    std::uint64_t frames = 0;  ///< bytes from the payload's start
    std::uint64_t stride = 0;  ///< bytes of a frame
    std::size_t windows = 0;   ///< number of the first one
};

/// About 300 bytes for each eight animated tracks, 100 for these in each segment, and 24 for each constant track.
struct UnpackPlan {
    const PackedView* packed = nullptr;
    std::vector<UnpackedConstant> constants;
    std::vector<UnpackGroup> groups;     ///< in the order of a frame's bits
    std::vector<UnpackSegment> segments;
    std::vector<UnpackWindows> windows;  ///< by segment, group, component
};

/// \param packed  must outlive the plan
/// \param rest    of the joints, as many as `packed` was read for
UnpackPlan make_unpack_plan(const PackedView& packed, std::span<const JointTransform> rest);

}  // namespace bendy
