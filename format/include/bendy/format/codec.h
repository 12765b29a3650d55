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

// Encodings of a leaf's whole payload: bits 8 to 15 of the header's flags. An encoded payload is a CodecHeader and what
// the codec makes of the rest; spec/codecs.md describes each to the bit.
namespace BENDY_PUBLIC bendy {

enum class Codec : std::uint8_t {
    raw = 0,
    zstd = 1,           ///< bytes, by planes if there is a stride
    vertices = 2,       ///< rows of a stream: meshoptimizer's vertex codec
    vertices_zstd = 3,  ///< the same under zstd
    indices = 4,        ///< triangle list: meshoptimizer's index codec
    indices_zstd = 5,   ///< the same under zstd
    clip = 6,           ///< packed clip: see packed_clip.h
    sums = 7,           ///< rows of u16 that sum to the same number, by planes under zstd
};
inline constexpr unsigned kCodecs = 8;

/// What every encoded payload starts with.
struct CodecHeader {
    std::uint64_t size = 0;    ///< bytes of the decoded payload
    std::uint16_t head = 0;    ///< bytes at its start that are not rows: vertices, indices; they follow as they are
    std::uint16_t stride = 0;  ///< bytes of a row; zstd: bytes of a number whose bytes lie in planes, 0 none
    std::uint32_t reserved = 0;
};
static_assert(sizeof(CodecHeader) == 16);

/// A leaf decodes to at most so many times its encoded bytes: a small file cannot take all memory.
inline constexpr std::uint64_t kMaxCodecRatio = 128;

/// Uninitialised bytes on a 16-byte boundary.
class AlignedBytes {
public:
    AlignedBytes() = default;
    explicit AlignedBytes(std::size_t size);

    [[nodiscard]] std::span<std::byte> span() { return {bytes_.get(), size_}; }
    [[nodiscard]] Bytes bytes() const { return {bytes_.get(), size_}; }

private:
    struct Delete {
        void operator()(std::byte* bytes) const;
    };
    std::unique_ptr<std::byte, Delete> bytes_;
    std::size_t size_ = 0;
};

/// What the encoded payload says of itself, or why it cannot be decoded: an unknown codec, a header that is damaged, a
/// size beyond kMaxCodecRatio. Errors have no place yet.
std::optional<Error> check_encoded(unsigned codec, Bytes encoded, CodecHeader& header);

/// Decodes into `out`, which must have the header's size; false if the bytes are damaged. Never reads or writes out of
/// bounds, whatever they hold.
bool decode_payload(Codec codec, Bytes encoded, std::span<std::byte> out);

/// The encoded form of a payload: `head` and `stride` as in CodecHeader. Nothing if the codec cannot take it (an index
/// list that is no list of triangles, rows that do not divide it), or if it would decode to more than kMaxCodecRatio.
std::optional<std::vector<std::byte>> encode_payload(Codec codec, Bytes payload, std::uint16_t head,
                                                     std::uint16_t stride);

/// The same triangles in the same order, each one's corners turned so that the index codecs give them back to the bit.
/// Nothing if the list is no list of triangles, or the codec cannot take it.
std::optional<std::vector<std::uint32_t>> canonical_triangles(std::span<const std::uint32_t> indices);

}  // namespace bendy
