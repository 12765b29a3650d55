#include <bendy/format/packed_clip.h>

#include "packed_layout.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
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

/// Returns the number of bits in a frame of the segment whose tables start at `at`; nothing if a width is not allowed,
/// or if all of a track's are 0.
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

}  // namespace bendy
