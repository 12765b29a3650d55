#include "unpack_plan.h"

#include "layout.h"

#include <glm/vec4.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace bendy {
namespace {

static_assert(UnpackGroup::kLanes == kPackedGroup &&
              UnpackBlock::kMaxHalfTurnSquare == static_cast<float>(kMaxHalfTurnSquare));
/// \param start  at rest
void set_constants(const PackedGroup& group, std::span<JointBlock> start) {
    for (std::uint32_t track = 0; track < group.count; ++track) {
        JointTransform joint = joint_in(start, group.joints[track]);
        set_unpacked(group, track, 0.0, joint);
        set_joint_in(start, group.joints[track], joint);
    }
}

/// Returns the rest values for a lane; rotations are normalised.
glm::vec4 rest_of(TrackPath path, const JointTransform& rest) {
    if (path == TrackPath::translation) return {rest.translation, 0.0f};
    if (path == TrackPath::scale) return {rest.scale, 0.0f};
    const glm::dvec4 q(rest.rotation.x, rest.rotation.y, rest.rotation.z, rest.rotation.w);
    const double square = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
    return square > 0.0 ? glm::vec4(q / std::sqrt(square)) : glm::vec4(0.0f, 0.0f, 0.0f, 1.0f);
}

UnpackGroup group_of(const PackedGroup& walked, std::span<const JointTransform> rest) {
    UnpackGroup group;
    group.is_rotation = walked.kind.path == TrackPath::rotation;
    group.components = walked.kind.components;
    group.count = walked.count;
    for (std::uint32_t lane = 0; lane < kPackedGroup; ++lane) {
        const std::uint32_t joint = walked.joints[lane < walked.count ? lane : walked.count - 1];
        group.places[lane] = place_of(joint, walked.kind.path);
        const glm::vec4 at_rest = rest_of(walked.kind.path, rest[joint]);
        for (int c = 0; c < 4; ++c) group.rest[c][lane] = at_rest[c];
    }
    return group;
}

/// Adds the blocks of joints that a group animates.
void add_parts(const PackedGroup& walked, UnpackGroup& group, std::vector<UnpackPart>& parts) {
    for (std::uint32_t lane = 0; lane < walked.count; ++lane) {
        const std::uint32_t joint = walked.joints[lane];
        const std::uint32_t place = place_of(joint - joint % kBlockJoints, walked.kind.path);
        const auto of_group = std::span(parts).last(group.parts);
        auto part =
            std::find_if(of_group.begin(), of_group.end(), [&](const UnpackPart& p) { return p.place == place; });
        if (part == of_group.end()) {
            parts.push_back({{}, {}, place});
            ++group.parts;
            part = std::span(parts).last(1).begin();
        }
        part->lanes[joint % kBlockJoints] = static_cast<std::int32_t>(lane);
        part->has_track[joint % kBlockJoints] = kAllBits;
    }
}

/// Sets the location of the group's bases, and its steps.
/// \param first   first track, in the list
/// \param tables  of the list, relative to the segment's
void place_group(const PackedList& list, std::uint32_t first, std::uint32_t tables, UnpackGroup& group) {
    group.base_bytes = list.base_bytes;
    group.bases = tables + group.components * list.count + first * list.base_bytes;
    group.stride = list.count * list.base_bytes;
    for (std::uint32_t c = 0; c < group.components; ++c) {
        for (std::uint32_t lane = 0; lane < group.count; ++lane) {
            const std::byte code = list.steps[std::size_t{c} * list.count + first + lane];
            group.steps[c][lane] = packed_step(static_cast<std::uint8_t>(code));
        }
    }
}

/// \param widths  of the lanes that hold a track
/// \param bit     position of the first number in a frame; advanced to the next component
UnpackWindows windows_of(Bytes widths, std::uint32_t& bit) {
    UnpackWindows windows;
    for (std::size_t lane = 0; lane < kPackedGroup; ++lane) {
        constexpr std::size_t kHalf = kPackedGroup / 2;
        if (lane == 0) windows.low = bit / 8;
        if (lane == kHalf) windows.high = bit / 8;
        const std::uint32_t width = lane < widths.size() ? std::to_integer<std::uint32_t>(widths[lane]) : 0;
        windows.bytes[lane] = static_cast<std::uint8_t>(bit / 8 - (lane < kHalf ? windows.low : windows.high));
        windows.left[lane] = static_cast<std::uint8_t>(32 - bit % 8 - width);
        windows.right[lane] = static_cast<std::uint8_t>(32 - width);
        bit += width;
    }
    return windows;
}

void add_windows(const PackedView& packed, const PackedSegment& segment, std::vector<UnpackWindows>& windows) {
    std::uint32_t bit = 0;
    std::uint64_t tables = segment.tables;
    for (std::size_t k = 0; k < kPackedLists; ++k) {
        if (!kPackedKinds[k].animated) continue;
        const PackedList& list = packed.lists[k];
        const std::uint64_t numbers = std::uint64_t{list.count} * kPackedKinds[k].components;
        const Bytes widths = packed.payload.subspan(tables, numbers);
        for (std::uint32_t first = 0; first < list.count; first += kPackedGroup) {
            const std::uint32_t count = std::min(kPackedGroup, list.count - first);
            for (std::size_t c = 0; c < kPackedKinds[k].components; ++c)
                windows.push_back(windows_of(widths.subspan(c * list.count + first, count), bit));
        }
        tables += numbers * (1 + list.base_bytes);
    }
}

}  // namespace

UnpackPlan make_unpack_plan(const PackedView& packed, std::span<const JointTransform> rest) {
    UnpackPlan plan;
    plan.packed = &packed;
    plan.start = to_blocks(rest);
    PackedGroupReader reader(packed, 0);
    std::uint32_t tables = 0;
    PackedGroup group;
    for (std::size_t k = 0; k < kPackedLists; ++k) {
        const PackedList& list = packed.lists[k];
        for (std::uint32_t first = 0; first < list.count; first += kPackedGroup) {
            reader.next(group);
            if (!group.kind.animated) {
                set_constants(group, plan.start);
                continue;
            }
            plan.groups.push_back(group_of(group, rest));
            add_parts(group, plan.groups.back(), plan.parts);
            place_group(list, first, tables, plan.groups.back());
        }
        if (kPackedKinds[k].animated) tables += kPackedKinds[k].components * list.count * (1 + list.base_bytes);
    }
    for (std::uint32_t s = 0; s < packed.segments; ++s) {
        const PackedSegment segment = packed_segment(packed, s * packed.record.segment_frames);
        plan.segments.push_back({segment.tables, segment.frames, segment.stride, plan.windows.size()});
        add_windows(packed, segment, plan.windows);
    }
    return plan;
}

namespace {

std::array<double, 3> numbers_of(const std::array<std::array<float, kPackedGroup>, 3>& numbers, std::uint32_t track) {
    return {numbers[0][track], numbers[1][track], numbers[2][track]};
}

}  // namespace

void set_unpacked(const PackedGroup& group, std::uint32_t track, double u, JointTransform& joint) {
    const std::array<double, 3> left = numbers_of(group.left, track);
    const std::array<double, 3> right = numbers_of(group.right, track);
    if (group.kind.path == TrackPath::rotation) {
        const glm::quat& rest = joint.rotation;
        const auto q = blend_packed_rotations({rest.x, rest.y, rest.z, rest.w}, left, right, u);
        joint.rotation = glm::quat(static_cast<float>(q[3]), static_cast<float>(q[0]), static_cast<float>(q[1]),
                                   static_cast<float>(q[2]));
        return;
    }
    glm::vec3& vector = group.kind.path == TrackPath::translation ? joint.translation : joint.scale;
    for (int c = 0; c < 3; ++c) {
        const auto at = static_cast<std::size_t>(c);
        vector[c] = static_cast<float>(vector[c] + (1.0 - u) * left[at] + u * right[at]);
    }
}

}  // namespace bendy
