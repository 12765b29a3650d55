#include <bendy/format/codec.h>

#include "codec_parts.h"

#include <algorithm>
#include <array>
#include <limits>
#include <new>
#include <span>

namespace bendy {
namespace {

constexpr std::align_val_t kAlignment{16};

// BENDY_ZSTD and BENDY_MESHOPTIMIZER are set by CMake; BENDY_WITH_ZSTD, ... apply to the two files that
// scripts/amalgamate.py makes.
#ifdef BENDY_WITHOUT_ZSTD
constexpr bool kHasZstd = false;
#else
constexpr bool kHasZstd = true;
#endif
#ifdef BENDY_WITHOUT_MESHOPTIMIZER
constexpr bool kHasMeshoptimizer = false;
#else
constexpr bool kHasMeshoptimizer = true;
#endif
constexpr bool kHasBoth = kHasMeshoptimizer && kHasZstd;

/// For each codec, true if it is an encoding and this program contains the libraries that it needs.
constexpr std::array<bool, kCodecs> kBuiltIn{
    false,              // raw
    kHasZstd,           // zstd
    kHasMeshoptimizer,  // vertices
    kHasBoth,           // vertices_zstd
    kHasMeshoptimizer,  // indices
    kHasBoth,           // indices_zstd
    kHasZstd,           // clip
    kHasZstd,           // sums
};

}  // namespace

AlignedBytes::AlignedBytes(std::uint64_t size) : size_(static_cast<std::size_t>(size)) {
    // Where a size_t has 32 bits, a file may ask for more than it can express: that fails like any allocation.
    constexpr std::uint64_t kMost = std::numeric_limits<std::size_t>::max() / 2;
    if (size > kMost) size_ = kMost;
    if (size_ != 0) bytes_.reset(static_cast<std::byte*>(::operator new(size_, kAlignment)));
}

void AlignedBytes::Delete::operator()(std::byte* bytes) const {
    ::operator delete(bytes, kAlignment);
}

std::optional<Error> check_encoded(unsigned codec, Bytes encoded, CodecHeader& header) {
    if (codec >= kCodecs || !kBuiltIn[codec]) return Error{ErrorCode::kUnsupportedCodec, 0, codec};
    if (encoded.size() < sizeof(CodecHeader)) {
        return Error{ErrorCode::kRecordTooShort, 0, encoded.size(), sizeof(CodecHeader)};
    }
    copy_at(encoded, 0, header);
    if (header.reserved != 0) return Error{ErrorCode::kReservedField, 0, header.reserved};
    const std::uint64_t most = encoded.size() * kMaxCodecRatio;
    if (header.size > most) return Error{ErrorCode::kCodecRatio, 0, header.size, most};
    return std::nullopt;
}

bool decode_payload(Codec codec, Bytes encoded, std::span<std::byte> out) {
    CodecHeader header;
    copy_at(encoded, 0, header);
    const Bytes body = encoded.subspan(sizeof header);
    switch (codec) {
        case Codec::zstd:
            return decode_zstd(header, body, out);
        case Codec::vertices:
        case Codec::vertices_zstd:
            return decode_rows(header, codec == Codec::vertices_zstd, body, out);
        case Codec::sums:
            return decode_sums(header, body, out);
        case Codec::indices:
        case Codec::indices_zstd:
            return decode_triangles(header, codec == Codec::indices_zstd, body, out);
        case Codec::clip:
            return header.head == 0 && header.stride == 0 && decode_clip(body, out);
        default:
            return false;
    }
}

std::optional<std::vector<std::byte>> encode_payload(Codec codec, Bytes payload, std::uint16_t head,
                                                     std::uint16_t stride) {
    const CodecHeader header{payload.size(), head, stride, 0};
    std::vector<std::byte> out(sizeof header);
    std::copy_n(std::as_bytes(std::span(&header, 1)).begin(), sizeof header, out.begin());
    bool is_done = false;
    switch (codec) {
        case Codec::zstd:
            is_done = encode_zstd(header, payload, out);
            break;
        case Codec::vertices:
        case Codec::vertices_zstd:
            is_done = encode_rows(header, codec == Codec::vertices_zstd, payload, out);
            break;
        case Codec::sums:
            is_done = encode_sums(header, payload, out);
            break;
        case Codec::indices:
        case Codec::indices_zstd:
            is_done = encode_triangles(header, codec == Codec::indices_zstd, payload, out);
            break;
        case Codec::clip:
            is_done = head == 0 && stride == 0 && encode_clip(payload, out);
            break;
        default:
            break;
    }
    if (!is_done || payload.size() > out.size() * kMaxCodecRatio) return std::nullopt;
    return out;
}

}  // namespace bendy
