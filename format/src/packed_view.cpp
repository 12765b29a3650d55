#include <bendy/format/packed_clip.h>

#include "packed_layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace bendy {
namespace {

using namespace packed;

/// Returns the last frame that is not after the time, by bisection.
PackedMoment uneven_moment(const PackedView& view, float seconds) {
    std::uint32_t left = 0;
    // No branch depends on a time, since none could be predicted for random moments.
    for (std::uint32_t count = view.record.frames; count > 1;) {
        const std::uint32_t half = count / 2;
        float middle = 0.0f;
        copy_at(view.payload, view.times_at + std::uint64_t{left + half} * 4, middle);
        left += middle <= seconds ? half : 0;
        count -= half;
    }
    const std::uint32_t right = left + 1;
    const double start = view.time_of(left);
    if (right == view.record.frames || !(seconds > start)) return {left, 0.0};
    const double fraction = (seconds - start) / (view.time_of(right) - start);
    return {left, fraction < 1.0 ? fraction : 0.0};
}

}  // namespace

float packed_step(std::uint8_t code) {
    constexpr std::array<double, 4> kRoots{1.0, 1.189207115002721, 1.4142135623730951, 1.681792830507429};
    return static_cast<float>(std::ldexp(kRoots[code % 4], code / 4 - 40));
}

bool PackedView::animates(std::uint32_t joint, TrackPath path) const {
    if (joint >= record.joints) return false;
    for (std::size_t k = 0; k < kPackedLists; ++k) {
        if (kPackedKinds[k].path != path || lists[k].count == 0) continue;
        if ((byte_at(lists[k].joints, joint / 8) >> (joint % 8) & 1u) != 0) return true;
    }
    return false;
}

double PackedView::time_of(std::uint32_t frame) const {
    if (is_even()) return double{record.start} + frame / double{record.frame_rate};
    float time = 0.0f;
    copy_at(payload, times_at + std::uint64_t{frame} * 4, time);
    return time;
}

PackedMoment packed_moment(const PackedView& view, float seconds) {
    if (!view.is_even()) return uneven_moment(view, seconds);
    const double frame = (double{seconds} - view.record.start) * view.record.frame_rate;
    const std::uint32_t last = view.record.frames - 1;
    if (!(frame > 0.0)) return {};
    if (frame >= last) return {last, 0.0};
    const auto whole = static_cast<std::uint32_t>(frame);
    return {whole, frame - whole};
}

PackedSegment packed_segment(const PackedView& view, std::uint32_t frame) {
    PackedSegment segment;
    std::uint64_t begin = view.first_segment;
    std::uint64_t end = view.payload.size() - kPackedTail;
    std::uint32_t number = 0;
    segment.count = view.record.frames;
    if (view.segments > 1) {
        number = std::min(frame / view.record.segment_frames, view.segments - 1);
        segment.first = number * view.record.segment_frames;
        std::uint32_t offset = 0;
        copy_at(view.payload, view.offsets_at + std::uint64_t{number} * 4, offset);
        begin = offset;
        if (number + 1 < view.segments) {
            copy_at(view.payload, view.offsets_at + std::uint64_t{number} * 4 + 4, offset);
            end = offset;
        }
        segment.count =
            number + 1 < view.segments ? view.record.segment_frames + 1u : view.record.frames - segment.first;
    }
    segment.tables = begin;
    segment.frames = begin + view.table_bytes;
    segment.stride = (end - segment.frames) / segment.count;
    return segment;
}

}  // namespace bendy
