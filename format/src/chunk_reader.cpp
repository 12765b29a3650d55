#include "walk_chunks.h"

#include <algorithm>
#include <cassert>

namespace bendy {
namespace {

struct RawHeader {
    std::uint32_t id = 0;
    std::uint32_t sum = 0;
    std::uint64_t size_and_flags = 0;
};
static_assert(sizeof(RawHeader) == kChunkHeaderSize);

Chunk read_header(Bytes bytes, std::uint64_t offset) {
    RawHeader raw;
    copy_at(bytes, offset, raw);
    Chunk chunk;
    chunk.id = FourCC(raw.id);
    chunk.sum = raw.sum;
    chunk.offset = offset;
    chunk.size = raw.size_and_flags & kMaxPayload;
    chunk.flags = static_cast<std::uint16_t>(raw.size_and_flags >> 48);
    return chunk;
}

/// Chunks to reserve room for at the start; files with one character rarely hold more.
constexpr std::uint64_t kUsualChunks = 256;

/// Checks a header by itself, regardless of what follows.
Result<void> check_header(const Chunk& chunk) {
    if (!chunk.id.is_readable()) return Error{ErrorCode::kChunkIdNotLetters, chunk.offset};
    if ((chunk.flags & kReservedFlags) != 0) {
        return Error{ErrorCode::kReservedFlags, chunk.offset, static_cast<std::uint64_t>(chunk.flags & kReservedFlags)};
    }
    if (chunk.is_container()) {
        if (chunk.codec() != 0) return Error{ErrorCode::kContainerCodec, chunk.offset, chunk.codec()};
        if (chunk.size % kChunkAlignment != 0) return Error{ErrorCode::kContainerSize, chunk.offset, chunk.size};
    }
    return {};
}

}  // namespace

Result<ChunkTree> walk_chunks(Bytes bytes, std::uint64_t most_chunks) {
    if (reinterpret_cast<std::uintptr_t>(bytes.data()) % kChunkAlignment != 0)
        return Error{ErrorCode::kUnalignedBuffer};
    if (bytes.size() < kChunkHeaderSize) return Error{ErrorCode::kNotABendyFile};

    Chunk root = read_header(bytes, 0);
    if (root.id != FourCC("HEAD")) return Error{ErrorCode::kNotABendyFile};
    if (const auto good = check_header(root); !good) return good.error();
    if (!root.is_container()) return Error{ErrorCode::kNotAContainer};
    const std::uint64_t available = bytes.size() - kChunkHeaderSize;
    if (root.size > available) return Error{ErrorCode::kTruncated, 0, root.size, available};
    if (root.size < available)
        return Error{ErrorCode::kTrailingBytes, root.size + kChunkHeaderSize, available - root.size};

    std::vector<Chunk> chunks;
    chunks.reserve(std::min<std::uint64_t>(bytes.size() / kChunkHeaderSize, kUsualChunks));
    chunks.push_back(root);
    std::vector<std::uint32_t> open{0};  // the containers around `at`, outermost first
    std::uint64_t at = kChunkHeaderSize;
    while (!open.empty()) {
        const std::uint32_t parent = open.back();
        const std::uint64_t parent_end = chunks[parent].payload_offset() + chunks[parent].size;
        if (at == parent_end) {
            chunks[parent].end = static_cast<std::uint32_t>(chunks.size());
            open.pop_back();
            continue;
        }
        const std::uint64_t left = parent_end - at;  // a multiple of 16, as all sizes so far
        assert(left >= kChunkHeaderSize);
        if (chunks.size() >= most_chunks) return Error{ErrorCode::kTooManyChunks, at, 0, most_chunks};

        Chunk chunk = read_header(bytes, at);
        if (const auto good = check_header(chunk); !good) return good.error();
        const std::uint64_t room = left - kChunkHeaderSize;
        // Containers end on boundaries, so room is a multiple of 16 and a payload that fits has room for its padding.
        if (chunk.size > room) return Error{ErrorCode::kChunkTooLong, at, chunk.size, room};
        chunk.parent = parent;
        at += kChunkHeaderSize;

        const auto number = static_cast<std::uint32_t>(chunks.size());
        chunk.end = number + 1;
        if (chunk.is_container()) {
            if (open.size() >= kMaxDepth) return Error{ErrorCode::kTooDeep, chunk.offset, 0, kMaxDepth};
            open.push_back(number);
        } else {
            const Bytes padding = bytes.subspan(at + chunk.size, padded(chunk.size) - chunk.size);
            if (std::any_of(padding.begin(), padding.end(), [](std::byte b) { return b != std::byte{0}; })) {
                return Error{ErrorCode::kPaddingNotZero, at + chunk.size};
            }
            at += padded(chunk.size);
        }
        chunks.push_back(chunk);
    }
    return ChunkTree(bytes, std::move(chunks));
}

Result<ChunkTree> read_chunk_tree(Bytes bytes) {
    return walk_chunks(bytes, kMaxChunks);
}

}  // namespace bendy
