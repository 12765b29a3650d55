#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/format/packed_clip.h>

#include <cstdint>

// Helpers shared by reading, decoding and writing PACK: single numbers of its payload, sizes of its parts.
namespace bendy::packed {

inline std::uint32_t byte_at(Bytes bytes, std::uint64_t at) {
    return static_cast<std::uint32_t>(bytes[at]);
}

/// \param size  2 or 4
inline std::int32_t base_at(Bytes payload, std::uint64_t at, std::uint32_t size) {
    if (size == 2) {
        std::int16_t base = 0;
        copy_at(payload, at, base);
        return base;
    }
    std::int32_t base = 0;
    copy_at(payload, at, base);
    return base;
}

/// \param width  at most kMaxPackedBits
inline std::uint32_t bits_at(Bytes payload, std::uint64_t bit, std::uint32_t width) {
    std::uint32_t word = 0;
    copy_at(payload, bit / 8, word);
    return (word >> (bit % 8)) & ((1u << width) - 1);
}

/// \param joint  below the record's number of joints
inline bool has_joint(const PackedList& list, std::uint32_t joint) {
    return (byte_at(list.joints, joint / 8) >> (joint % 8) & 1u) != 0;
}

/// Returns the size of the widths and bases of a list in one segment, in bytes.
inline std::uint64_t table_bytes(const PackedList& list, const PackedKind& kind) {
    return std::uint64_t{list.count} * kind.components * (1 + list.base_bytes);
}

/// For clips with an animated track.
inline std::uint32_t segment_count(const PackRecord& record) {
    if (record.segment_frames == 0 || record.frames < 2) return 1;
    return (record.frames - 2) / record.segment_frames + 1;
}

}  // namespace bendy::packed
