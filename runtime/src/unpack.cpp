#include "unpack.h"

#include "pose_kernels.h"

#include <algorithm>
#include <cstring>

namespace bendy {
namespace {

std::array<double, 3> numbers_of(const std::array<std::array<float, kPackedGroup>, 3>& numbers, std::uint32_t track) {
    return {numbers[0][track], numbers[1][track], numbers[2][track]};
}

void store_constants(std::span<const UnpackedConstant> constants, float* floats) {
    for (const UnpackedConstant& constant : constants) {
        float* const out = floats + constant.place;
        std::memcpy(out, constant.value.data(), 3 * sizeof(float));
        if (constant.floats == 4) out[3] = constant.value[3];
    }
}

UnpackBlock block_at(const UnpackPlan& plan, float seconds, float* floats) {
    const PackedView& packed = *plan.packed;
    const PackedMoment moment = packed_moment(packed, seconds);
    const std::uint32_t from_segment_to_segment = packed.record.segment_frames;
    const UnpackSegment* segment = plan.segments.data();
    std::uint32_t frame = moment.frame;
    if (packed.segments > 1) {
        const std::uint32_t number = std::min(frame / from_segment_to_segment, packed.segments - 1);
        segment += number;
        frame -= number * from_segment_to_segment;
    }
    const auto* const payload = reinterpret_cast<const unsigned char*>(packed.payload.data());  // NOLINT(*-cast)
    UnpackBlock block{};
    block.groups = plan.groups.data();
    block.group_count = plan.groups.size();
    block.windows = plan.windows.data() + segment->windows;
    block.tables = payload + segment->tables;
    block.left = payload + segment->frames + frame * segment->stride;
    block.right = moment.frame + 1 < packed.record.frames ? block.left + segment->stride : block.left;
    block.end = payload + packed.payload.size();
    block.fraction = static_cast<float>(moment.fraction);
    block.is_near_end = static_cast<std::size_t>(block.end - block.right) < segment->stride + UnpackBlock::kReadPast;
    block.local = floats;
    return block;
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

void unpack_plain(const UnpackPlan& plan, float seconds, std::span<JointTransform> local) {
    const PackedView& packed = *plan.packed;
    if (packed.record.joints > local.size()) return;
    const PackedMoment moment = packed_moment(packed, seconds);
    PackedWalk walk(packed, moment.frame);
    for (PackedGroup group; walk.next(group);) {
        for (std::uint32_t track = 0; track < group.count; ++track)
            set_unpacked(group, track, moment.fraction, local[group.joints[track]]);
    }
}

void unpack(const UnpackPlan& plan, float seconds, std::span<JointTransform> local) {
    const PoseKernels* const kernels = pose_kernels();
    if (kernels == nullptr) return unpack_plain(plan, seconds, local);
    if (plan.packed->record.joints > local.size() || local.empty()) return;
    float* const floats = &local.front().rotation.x;
    store_constants(plan.constants, floats);
    if (!plan.groups.empty()) kernels->unpack(block_at(plan, seconds, floats));
}

}  // namespace bendy
