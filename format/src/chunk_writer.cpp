#include <bendy/format/chunk_writer.h>

#include <bendy/format/chunk_reader.h>
#include <bendy/format/limits.h>

#include <cassert>
#include <cstring>
#include <utility>

namespace bendy {
namespace {

template <class T>
void store(std::vector<std::byte>& bytes, std::uint64_t offset, T value) {
    std::memcpy(bytes.data() + offset, &value, sizeof value);
}

}  // namespace

void ChunkWriter::put_header(FourCC id, std::uint16_t flags) {
    assert(!open_.empty() || bytes_.empty());  // one root, nothing after it
    const std::uint64_t offset = bytes_.size();
    bytes_.resize(offset + kChunkHeaderSize);
    store(bytes_, offset, id.value);
    store(bytes_, offset + kChunkSizeAt, pack_size_and_flags(0, flags));
    open_.push_back(offset);
}

void ChunkWriter::reserve(std::uint64_t bytes) {
    bytes_.reserve(bytes);
}

void ChunkWriter::begin(FourCC id, std::uint16_t flags) {
    put_header(id, static_cast<std::uint16_t>(flags | kContainerFlag));
}

void ChunkWriter::end(std::uint16_t flags) {
    assert(!open_.empty());
    const std::uint64_t offset = open_.back();
    open_.pop_back();
    const std::uint64_t size = bytes_.size() - offset - kChunkHeaderSize;
    assert(size <= kMaxPayload);
    std::uint64_t size_and_flags = 0;
    copy_at(Bytes(bytes_), offset + kChunkSizeAt, size_and_flags);
    store(bytes_, offset + kChunkSizeAt, size_and_flags | pack_size_and_flags(size, flags));
    bytes_.resize(offset + kChunkHeaderSize + padded(size));
    store(bytes_, offset + kChunkSumAt, chunk_sum(Bytes(bytes_).subspan(offset)));
}

void ChunkWriter::leaf(FourCC id, Bytes payload, std::uint16_t flags) {
    leaf(id, std::span(&payload, 1), flags);
}

void ChunkWriter::leaf(FourCC id, std::span<const Bytes> pieces, std::uint16_t flags) {
    assert((flags & kContainerFlag) == 0);
    put_header(id, flags);
    for (const Bytes piece : pieces) bytes_.insert(bytes_.end(), piece.begin(), piece.end());
    end();
}

void ChunkWriter::copy(Bytes whole_chunk) {
    assert(!open_.empty() && whole_chunk.size() % kChunkAlignment == 0);
    bytes_.insert(bytes_.end(), whole_chunk.begin(), whole_chunk.end());
}

std::vector<std::byte> ChunkWriter::finish() && {
    assert(open_.empty());
    return std::move(bytes_);
}

}  // namespace bendy
