#include <bendy/format/find_key.h>
#include <bendy/format/packed_clip.h>

#include "packed_layout.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>

namespace bendy {
namespace {

using namespace packed;

/// Takes one part after another off the payload; after a part that does not fit, all others fail.
class Parts {
public:
    explicit Parts(Bytes payload) : payload_(payload) {}

    Bytes take(std::uint64_t size) {
        if (is_short_ || size > payload_.size() - at_) {
            is_short_ = true;
            return {};
        }
        at_ += size;
        return payload_.subspan(at_ - size, size);
    }
    [[nodiscard]] std::uint64_t at() const { return at_; }
    [[nodiscard]] bool is_short() const { return is_short_; }

private:
    Bytes payload_;
    std::uint64_t at_ = 0;
    bool is_short_ = false;
};

std::uint64_t all_table_bytes(const PackedView& view) {
    std::uint64_t bytes = 0;
    for (std::size_t k = 0; k < kPackedLists; ++k) {
        if (kPackedKinds[k].animated) bytes += table_bytes(view.lists[k], kPackedKinds[k]);
    }
    return bytes;
}

/// Reads the bits of one list: one per joint of the record, and none beyond.
bool read_joints(Bytes bits, std::uint32_t joints, PackedList& list) {
    list.joints = bits;
    for (const std::byte byte : bits)
        list.count += static_cast<std::uint32_t>(std::popcount(std::to_integer<unsigned>(byte)));
    return joints % 8 == 0 || bits.empty() || byte_at(bits, bits.size() - 1) >> (joints % 8) == 0;
}

/// Returns the number of bits in a frame of the segment whose tables start at `at`; nothing if a width is too large,
/// or if every width of some track is 0.
std::optional<std::uint64_t> frame_bits(const PackedView& view, std::uint64_t at) {
    std::uint64_t bits = 0;
    for (std::size_t k = 0; k < kPackedLists; ++k) {
        const PackedList& list = view.lists[k];
        const PackedKind& kind = kPackedKinds[k];
        if (!kind.animated) continue;
        for (std::uint32_t track = 0; track < list.count; ++track) {
            std::uint64_t of_track = 0;
            for (std::uint32_t c = 0; c < kind.components; ++c) {
                const std::uint32_t width = byte_at(view.payload, at + std::uint64_t{c} * list.count + track);
                if (width > kMaxPackedBits) return std::nullopt;
                of_track += width;
            }
            if (of_track == 0) return std::nullopt;
            bits += of_track;
        }
        at += table_bytes(list, kind);
    }
    return bits;
}

/// Checks the segments' offsets and sizes against the payload.
bool check_segments(const PackedView& view, Parts parts, std::uint64_t offset, Faults& faults) {
    const PackRecord& record = view.record;
    const std::uint64_t tables = all_table_bytes(view);
    for (std::uint32_t s = 0; s < view.segments; ++s) {
        if (view.segments > 1) {
            std::uint32_t stated = 0;
            copy_at(view.payload, view.offsets_at + std::uint64_t{s} * 4, stated);
            if (stated != parts.at()) {
                faults.add({ErrorCode::kCountMismatch, offset, stated, parts.at()});
                return false;
            }
        }
        const std::uint64_t at = parts.at();
        parts.take(tables);
        const auto bits = parts.is_short() ? std::nullopt : frame_bits(view, at);
        if (!parts.is_short() && !bits) {
            faults.add({ErrorCode::kEnumRange, offset, s, kMaxPackedBits});
            return false;
        }
        const std::uint32_t first = s * record.segment_frames;
        const std::uint32_t count = s + 1 < view.segments ? record.segment_frames + 1u : record.frames - first;
        parts.take(count * ((bits.value_or(0) + 7) / 8));
        if (parts.is_short()) break;
    }
    const Bytes tail = parts.take(kPackedTail);
    if (parts.is_short() || parts.at() != view.payload.size()) {
        faults.add({ErrorCode::kRecordSize, offset, view.payload.size(), parts.at()});
        return false;
    }
    if (std::any_of(tail.begin(), tail.end(), [](std::byte b) { return b != std::byte{}; })) {
        faults.add({ErrorCode::kReservedField, offset, 1});
        return false;
    }
    return true;
}

PackedMoment uneven_moment(const PackedView& view, float seconds) {
    const std::byte* const times = view.payload.data() + view.times_at;
    const auto time_at = [times](std::size_t frame) {
        float time = 0.0f;
        std::memcpy(&time, times + frame * sizeof time, sizeof time);
        return time;
    };
    const auto left = static_cast<std::uint32_t>(find_key(view.record.frames, time_at, seconds));
    const std::uint32_t right = left + 1;
    const double start = time_at(left);
    if (right == view.record.frames || !(seconds > start)) return {left, 0.0};
    const double fraction = (seconds - start) / (time_at(right) - start);
    return {left, fraction < 1.0 ? fraction : 0.0};
}

}  // namespace

std::optional<PackedView> read_packed(Bytes payload, std::uint32_t joints, std::uint64_t offset, Faults& faults) {
    PackedView view;
    view.payload = payload;
    PackRecord& record = view.record;
    if (payload.size() < sizeof record) {
        faults.add({ErrorCode::kRecordTooShort, offset, payload.size(), sizeof record});
        return std::nullopt;
    }
    copy_at(payload, 0, record);
    if (record.joints > joints) {
        faults.add({ErrorCode::kJointRange, offset, record.joints, joints});
        return std::nullopt;
    }
    if (record.reserved != decltype(record.reserved){} || (record.wide & ~record.lists) != 0) {
        faults.add({ErrorCode::kReservedField, offset, 1});
        return std::nullopt;
    }
    Parts parts(payload);
    parts.take(sizeof record);
    for (std::size_t k = 0; k < kPackedLists; ++k) {
        if ((record.lists >> k & 1u) == 0) continue;
        if (read_joints(parts.take((record.joints + 7u) / 8), record.joints, view.lists[k])) continue;
        faults.add({ErrorCode::kJointRange, offset, record.joints, joints});
        return std::nullopt;
    }
    for (std::size_t k = 0; k < kPackedLists; ++k) {
        PackedList& list = view.lists[k];
        list.steps = parts.take(std::uint64_t{list.count} * kPackedKinds[k].components);
        list.base_bytes = (record.wide >> k & 1u) != 0 ? 4 : 2;
        if (kPackedKinds[k].animated) view.animated_numbers += list.count * kPackedKinds[k].components;
    }
    for (std::size_t k = 0; k < kPackedLists; ++k) {
        PackedList& list = view.lists[k];
        if (!kPackedKinds[k].animated)
            list.constants = parts.take(std::uint64_t{list.count} * kPackedKinds[k].components * list.base_bytes);
    }
    if (record.frames == 0 || (record.frames < 2 && view.animated_numbers > 0)) {
        faults.add({ErrorCode::kKeyRange, offset, 0});
        return std::nullopt;
    }
    view.table_bytes = all_table_bytes(view);
    view.segments = view.animated_numbers == 0 ? 0 : segment_count(record);
    view.times_at = parts.at();
    if (record.frame_rate == 0.0f) parts.take(std::uint64_t{record.frames} * 4);
    view.offsets_at = parts.at();
    if (view.segments > 1) parts.take(std::uint64_t{view.segments} * 4);
    view.first_segment = parts.at();
    if (parts.is_short()) {
        faults.add({ErrorCode::kRecordSize, offset, payload.size(), parts.at()});
        return std::nullopt;
    }
    if (!check_segments(view, parts, offset, faults)) return std::nullopt;
    return view;
}

void check_packed_values(const PackedView& view, std::uint64_t offset, Faults& faults) {
    const PackRecord& record = view.record;
    for (const float number : {record.start, record.frame_rate}) {
        if (!std::isfinite(number)) faults.add({ErrorCode::kNotFinite, offset, 0});
    }
    if (record.frame_rate < 0.0f) faults.add({ErrorCode::kBelowZero, offset, 8});
    if (view.is_even()) return;
    for (std::uint32_t f = 0; f < record.frames; ++f) {
        const double time = view.time_of(f);
        if (!std::isfinite(time)) {
            faults.add({ErrorCode::kNotFinite, offset, f});
            return;
        }
        if (f > 0 ? !(time > view.time_of(f - 1)) : time != double{record.start}) {
            faults.add({ErrorCode::kKeyOrder, offset, f});
            return;
        }
    }
}

float packed_step(std::uint8_t code) {
    constexpr std::array<double, 4> kRoots{1.0, 1.189207115002721, 1.4142135623730951, 1.681792830507429};
    return static_cast<float>(std::ldexp(kRoots[code % 4], code / 4 - 40));
}

bool PackedView::animates(std::uint32_t joint, TrackPath path) const {
    if (joint >= record.joints) return false;
    for (std::size_t k = 0; k < kPackedLists; ++k) {
        if (kPackedKinds[k].path != path || lists[k].count == 0) continue;
        if (has_joint(lists[k], joint)) return true;
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
        if (has_joint(list, joint_)) group.joints[found++] = joint_;
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
