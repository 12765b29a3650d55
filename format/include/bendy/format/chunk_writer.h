#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/format/chunk.h>
#include <bendy/format/public.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace BENDY_PUBLIC bendy {

/// Builds a file in memory: begin and end containers, write leaves; sizes, padding and sums are computed here. Misuse
/// (one end too many, a payload of 2^48 bytes) is a bug of the caller and is asserted.
class ChunkWriter {
public:
    /// Reserves room for a file of this size, so that a large one is not copied as it grows.
    void reserve(std::uint64_t bytes);
    void begin(FourCC id, std::uint16_t flags = 0);
    /// \param flags  set in addition to those given at the container's beginning
    void end(std::uint16_t flags = 0);

    /// Writes a leaf from one payload, or from pieces that follow one another.
    void leaf(FourCC id, Bytes payload, std::uint16_t flags = 0);
    void leaf(FourCC id, std::span<const Bytes> pieces, std::uint16_t flags = 0);
    void text_leaf(FourCC id, std::string_view text) { leaf(id, as_byte_span(text)); }

    /// Copies a chunk of another file with its subtree, byte for byte: header, payload, padding.
    void copy(Bytes whole_chunk);

    /// Returns the finished file; every container must have been ended.
    std::vector<std::byte> finish() &&;

private:
    void put_header(FourCC id, std::uint16_t flags);

    std::vector<std::byte> bytes_;
    std::vector<std::uint64_t> open_;  // offsets of the headers of open containers
};

/// Returns a trivially copyable record or array as payload bytes.
template <class T>
Bytes bytes_of(const T& value) {
    return std::as_bytes(std::span(&value, 1));
}

}  // namespace bendy
