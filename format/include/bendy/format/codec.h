#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/format/error.h>
#include <bendy/format/public.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

// Encodings of a leaf's whole payload: bits 8 to 15 of the header's flags. An encoded payload is a CodecHeader followed
// by the codec's output; spec/codecs.md describes each codec bit by bit.
namespace BENDY_PUBLIC bendy {

enum class Codec : std::uint8_t {
    raw = 0,
    zstd = 1,           ///< bytes; split into byte planes if there is a stride
    vertices = 2,       ///< rows of a stream: meshoptimizer's vertex codec
    vertices_zstd = 3,  ///< the same, compressed with zstd
    indices = 4,        ///< triangle list: meshoptimizer's index codec
    indices_zstd = 5,   ///< the same, compressed with zstd
    clip = 6,           ///< packed clip: see packed_clip.h
    sums = 7,           ///< rows of u16 with equal sums, in byte planes, compressed with zstd
};
inline constexpr unsigned kCodecs = 8;

/// The start of every encoded payload.
struct CodecHeader {
    std::uint64_t size = 0;    ///< size of the decoded payload in bytes
    std::uint16_t head = 0;    ///< bytes at its start that precede the rows, stored as they are: vertices, indices
    std::uint16_t stride = 0;  ///< size of a row in bytes; zstd: size of a number whose bytes are in planes, 0 none
    std::uint32_t reserved = 0;
};
static_assert(sizeof(CodecHeader) == 16);

/// The maximum ratio of decoded to encoded size, so that a small file cannot use up all memory.
inline constexpr std::uint64_t kMaxCodecRatio = 128;

/// Uninitialised bytes on a 16-byte boundary.
class AlignedBytes {
public:
    AlignedBytes() = default;
    explicit AlignedBytes(std::uint64_t size);

    [[nodiscard]] std::span<std::byte> span() { return {bytes_.get(), size_}; }
    [[nodiscard]] Bytes bytes() const { return {bytes_.get(), size_}; }

private:
    struct Delete {
        void operator()(std::byte* bytes) const;
    };
    std::unique_ptr<std::byte, Delete> bytes_;
    std::size_t size_ = 0;
};

/// Reads the header of an encoded payload. Returns why it cannot be decoded, if so: an unknown codec, a damaged header,
/// a size beyond kMaxCodecRatio. Errors have no offset yet.
std::optional<Error> check_encoded(unsigned codec, Bytes encoded, CodecHeader& header);

/// Decodes into `out`, which must have the header's size; returns false if the bytes are damaged. Never reads or writes
/// out of bounds, whatever the bytes are.
bool decode_payload(Codec codec, Bytes encoded, std::span<std::byte> out);

/// Encodes a payload: `head` and `stride` as in CodecHeader. Returns nothing if the codec cannot encode it (an index
/// list that is not a triangle list, rows that do not divide it), or if it would exceed kMaxCodecRatio.
std::optional<std::vector<std::byte>> encode_payload(Codec codec, Bytes payload, std::uint16_t head,
                                                     std::uint16_t stride);

/// Returns the same triangles in the same order, each with its corners rotated such that the index codecs reproduce
/// them exactly. Returns nothing if the list is not a triangle list, or if the codec cannot encode it.
std::optional<std::vector<std::uint32_t>> canonical_triangles(std::span<const std::uint32_t> indices);

}  // namespace bendy
