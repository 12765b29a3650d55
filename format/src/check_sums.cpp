#include <bendy/format/check_sums.h>

#include <bendy/format/crc32c.h>

#include <array>
#include <cstddef>
#include <cstring>

namespace bendy {
namespace {

/// Adds the stored sums of a container's children, in blocks.
std::uint32_t add_children(Bytes payload, std::uint32_t sum) {
    std::array<std::uint32_t, 64> sums;  // NOLINT(*-member-init): only those that are set are used
    std::size_t count = 0;
    for (std::uint64_t at = 0; at < payload.size();) {
        copy_at(payload, at + kChunkSumAt, sums[count++]);
        std::uint64_t child = 0;
        copy_at(payload, at + kChunkSizeAt, child);
        at += kChunkHeaderSize + padded(child & kMaxPayload);
        if (count < sums.size() && at < payload.size()) continue;
        sum = crc32c(std::as_bytes(std::span(sums).first(count)), sum);
        count = 0;
    }
    return sum;
}

}  // namespace

std::uint32_t chunk_sum(Bytes chunk) {
    std::uint64_t size_and_flags = 0;
    copy_at(chunk, kChunkSizeAt, size_and_flags);
    const std::uint64_t size = size_and_flags & kMaxPayload;
    const bool is_container = (size_and_flags >> 48 & kContainerFlag) != 0;

    // The id and the fields after the sum, contiguously.
    std::array<std::byte, sizeof(std::uint32_t) + sizeof size_and_flags> head;
    std::memcpy(head.data(), chunk.data(), sizeof(std::uint32_t));
    std::memcpy(head.data() + sizeof(std::uint32_t), &size_and_flags, sizeof size_and_flags);
    const std::uint32_t sum = crc32c(head);
    const Bytes payload = chunk.subspan(kChunkHeaderSize, size);
    return is_container ? add_children(payload, sum) : crc32c(payload, sum);
}

void check_sums(const ChunkTree& tree, Faults& faults) {
    for (const Chunk& chunk : tree.chunks()) {
        const std::uint32_t sum = chunk_sum(tree.bytes().subspan(chunk.offset));
        if (sum != chunk.sum) faults.add({ErrorCode::kSumMismatch, chunk.offset, sum, chunk.sum});
    }
}

}  // namespace bendy
