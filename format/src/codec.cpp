#include <bendy/format/codec.h>

#include "cycle_codec.h"

#include <zstd.h>

#include <algorithm>
#include <new>

namespace bendy {
namespace {

constexpr std::align_val_t kAlignment{16};
constexpr int kZstdLevel = 19;

/// Bytes of numbers of `stride` bytes, plane by plane: all first bytes, then all second ones; what is left over at the
/// end stays as it is.
void to_planes(Bytes numbers, std::size_t stride, std::span<std::byte> planes) {
    const std::size_t count = numbers.size() / stride;
    for (std::size_t n = 0; n < count; ++n) {
        for (std::size_t b = 0; b < stride; ++b) planes[b * count + n] = numbers[n * stride + b];
    }
    std::copy(numbers.begin() + static_cast<std::ptrdiff_t>(count * stride), numbers.end(),
              planes.begin() + static_cast<std::ptrdiff_t>(count * stride));
}

void from_planes(Bytes planes, std::size_t stride, std::span<std::byte> numbers) {
    const std::size_t count = numbers.size() / stride;
    for (std::size_t b = 0; b < stride; ++b) {
        for (std::size_t n = 0; n < count; ++n) numbers[n * stride + b] = planes[b * count + n];
    }
    std::copy(planes.begin() + static_cast<std::ptrdiff_t>(count * stride), planes.end(),
              numbers.begin() + static_cast<std::ptrdiff_t>(count * stride));
}

/// Appends the bytes under zstd.
bool put_zstd(Bytes bytes, std::vector<std::byte>& out) {
    const std::size_t at = out.size();
    out.resize(at + ZSTD_compressBound(bytes.size()));
    const std::size_t size = ZSTD_compress(out.data() + at, out.size() - at, bytes.data(), bytes.size(), kZstdLevel);
    if (ZSTD_isError(size) != 0) return false;
    out.resize(at + size);
    return true;
}

/// True if the bytes are one zstd frame of exactly out.size() bytes.
bool take_zstd(Bytes bytes, std::span<std::byte> out) {
    const std::size_t size = ZSTD_decompress(out.data(), out.size(), bytes.data(), bytes.size());
    return ZSTD_isError(size) == 0 && size == out.size();
}

bool decode_zstd(const CodecHeader& header, Bytes body, std::span<std::byte> out) {
    if (header.stride <= 1) return take_zstd(body, out);
    AlignedBytes planes(out.size());
    if (!take_zstd(body, planes.span())) return false;
    from_planes(planes.bytes(), header.stride, out);
    return true;
}

bool encode_zstd(Bytes payload, std::uint16_t stride, std::vector<std::byte>& out) {
    if (stride <= 1) return put_zstd(payload, out);
    AlignedBytes planes(payload.size());
    to_planes(payload, stride, planes.span());
    return put_zstd(planes.bytes(), out);
}

}  // namespace

AlignedBytes::AlignedBytes(std::size_t size)
    : bytes_(size == 0 ? nullptr : static_cast<std::byte*>(::operator new(size, kAlignment))), size_(size) {}

void AlignedBytes::Delete::operator()(std::byte* bytes) const {
    ::operator delete(bytes, kAlignment);
}

std::optional<Error> check_encoded(unsigned codec, Bytes encoded, CodecHeader& header) {
    if (codec == 0 || codec >= kCodecs) return Error{ErrorCode::kUnsupportedCodec, 0, codec};
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
        case Codec::cycle:
            return header.head == 0 && header.stride == 0 && decode_cycle(body, out);
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
            is_done = encode_zstd(payload, stride, out);
            break;
        case Codec::cycle:
            is_done = head == 0 && stride == 0 && encode_cycle(payload, out);
            break;
        default:
            break;
    }
    if (!is_done || payload.size() > out.size() * kMaxCodecRatio) return std::nullopt;
    return out;
}

}  // namespace bendy
