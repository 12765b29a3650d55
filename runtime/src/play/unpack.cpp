#include "unpack.h"

#include "kernels/kernel_table.h"
#include "plan/unpack_plan.h"

#include <algorithm>
#include <cstddef>

namespace bendy {
namespace {

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
    block.parts = plan.parts.data();
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

void unpack(const UnpackPlan& plan, float seconds, std::size_t joints, std::span<JointBlock> local) {
    if (plan.packed->record.joints > joints || plan.groups.empty()) return;
    kernel_table().unpack(block_at(plan, seconds, &local.front().rotation[0][0]));
}

}  // namespace bendy
