#include <bendy/format/packed_clip.h>

#include "packed_layout.h"

#include <algorithm>
#include <cstdint>

namespace bendy {
using namespace packed;

PackedGroupReader::PackedGroupReader(const PackedView& view, std::uint32_t frame) : view_(view) {
    if (view.animated_numbers == 0) return;
    segment_ = packed_segment(view, frame);
    const std::uint32_t right = std::min(frame + 1, view.record.frames - 1);
    tables_ = segment_.tables;
    bit_left_ = (segment_.frames + (frame - segment_.first) * segment_.stride) * 8;
    bit_right_ = (segment_.frames + (right - segment_.first) * segment_.stride) * 8;
}

bool PackedGroupReader::next(PackedGroup& group) {
    while (list_ < kPackedLists && track_ >= view_.lists[list_].count) {
        if (kPackedKinds[list_].animated) tables_ += table_bytes(view_.lists[list_], kPackedKinds[list_]);
        ++list_;
        track_ = 0;
        joint_ = 0;
    }
    if (list_ >= kPackedLists) return false;
    const PackedList& list = view_.lists[list_];
    group.kind = kPackedKinds[list_];
    group.count = std::min(kPackedGroup, list.count - track_);
    for (std::uint32_t found = 0; found < group.count; ++joint_) {
        if ((byte_at(list.joints, joint_ / 8) >> (joint_ % 8) & 1u) != 0) group.joints[found++] = joint_;
    }
    read_numbers(list, track_, group);
    track_ += group.count;
    return true;
}

void PackedGroupReader::read_numbers(const PackedList& list, std::uint32_t first, PackedGroup& group) {
    const std::uint32_t components = group.kind.components;
    const std::uint64_t bases = tables_ + std::uint64_t{components} * list.count;
    for (std::uint32_t c = 0; c < components; ++c) {
        for (std::uint32_t t = 0; t < group.count; ++t) {
            const std::uint64_t number = std::uint64_t{c} * list.count + first + t;
            const float step = packed_step(static_cast<std::uint8_t>(list.steps[number]));
            const auto value = [&](std::int32_t base, std::uint32_t bits) {
                return static_cast<float>(static_cast<std::int32_t>(static_cast<std::uint32_t>(base) + bits)) * step;
            };
            if (!group.kind.animated) {
                const std::int32_t base = base_at(list.constants, number * list.base_bytes, list.base_bytes);
                group.left[c][t] = group.right[c][t] = value(base, 0);
                continue;
            }
            const std::uint32_t width = byte_at(view_.payload, tables_ + number);
            const std::int32_t base = base_at(view_.payload, bases + number * list.base_bytes, list.base_bytes);
            group.left[c][t] = value(base, bits_at(view_.payload, bit_left_, width));
            group.right[c][t] = value(base, bits_at(view_.payload, bit_right_, width));
            bit_left_ += width;
            bit_right_ += width;
        }
    }
    for (std::uint32_t c = components; c < 3; ++c) {
        group.left[c] = group.left[0];
        group.right[c] = group.right[0];
    }
}

}  // namespace bendy
