#include <bendy/format/check_sums.h>

#include <bendy/format/crc32c.h>

namespace bendy {

std::uint32_t chunk_sum(Bytes chunk) {
    constexpr std::uint64_t kSumAt = 4;
    constexpr std::uint64_t kSizeAt = 8;
    std::uint64_t size_and_flags = 0;
    copy_at(chunk, kSizeAt, size_and_flags);
    const std::uint64_t size = size_and_flags & kMaxPayload;
    const bool is_container = (size_and_flags >> 48 & kContainerFlag) != 0;

    std::uint32_t sum = crc32c(chunk.first(kSumAt));
    sum = crc32c(chunk.subspan(kSizeAt, sizeof size_and_flags), sum);
    const Bytes payload = chunk.subspan(kChunkHeaderSize, size);
    if (!is_container) return crc32c(payload, sum);
    for (std::uint64_t at = 0; at < payload.size();) {
        sum = crc32c(payload.subspan(at + kSumAt, sizeof(std::uint32_t)), sum);
        std::uint64_t child = 0;
        copy_at(payload, at + kSizeAt, child);
        at += kChunkHeaderSize + padded(child & kMaxPayload);
    }
    return sum;
}

void check_sums(const ChunkTree& tree, Faults& faults) {
    for (const Chunk& chunk : tree.chunks()) {
        const std::uint32_t sum = chunk_sum(tree.bytes().subspan(chunk.offset));
        if (sum != chunk.sum) faults.add({ErrorCode::kSumMismatch, chunk.offset, sum, chunk.sum});
    }
}

}  // namespace bendy
