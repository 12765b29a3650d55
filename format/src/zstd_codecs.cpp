#include "codec_parts.h"

#ifndef BENDY_WITHOUT_ZSTD
#include <zstd.h>
#include <zstd_errors.h>
#endif

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <new>

namespace bendy {

#ifndef BENDY_WITHOUT_ZSTD

namespace {

constexpr int kZstdLevel = 17;
// Longer payloads get a faster level, so that a mesh of a million vertices takes seconds.
constexpr std::size_t kLong = std::size_t{1} << 21U;
constexpr int kLongLevel = 13;

/// zstd has run out of memory: continues like any other failed allocation, as operator new decides, so that the file is
/// not reported as damaged.
void fail_as_allocation() {
    constexpr std::size_t kMoreThanThereIs = std::numeric_limits<std::size_t>::max() / 2;
    ::operator delete(::operator new(kMoreThanThereIs));
}

bool is_good(std::size_t result) {
    if (ZSTD_getErrorCode(result) == ZSTD_error_memory_allocation) fail_as_allocation();
    return ZSTD_isError(result) == 0;
}

struct Free {
    void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
    void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
};

/// One per thread, and kept: creating one queries the processor, which takes tens of microseconds in virtual machines,
/// and a file may have hundreds of frames.
ZSTD_DCtx* decompressor() {
    thread_local std::unique_ptr<ZSTD_DCtx, Free> context;
    if (context == nullptr) context.reset(ZSTD_createDCtx());
    if (context == nullptr) fail_as_allocation();
    return context.get();
}

/// As above: its tables would be allocated anew for each frame.
std::unique_ptr<ZSTD_CCtx, Free>& compressor() {
    thread_local std::unique_ptr<ZSTD_CCtx, Free> context;
    if (context == nullptr) context.reset(ZSTD_createCCtx());
    if (context == nullptr) fail_as_allocation();
    return context;
}

}  // namespace

bool put_zstd(Bytes bytes, std::vector<std::byte>& out) {
    const std::size_t at = out.size();
    out.resize(at + ZSTD_compressBound(bytes.size()));
    const bool is_long = bytes.size() > kLong;
    auto& context = compressor();
    const std::size_t size = ZSTD_compressCCtx(context.get(), out.data() + at, out.size() - at, bytes.data(),
                                               bytes.size(), is_long ? kLongLevel : kZstdLevel);
    if (is_long) context.reset();  // its tables are as large as the frame
    if (!is_good(size)) return false;
    out.resize(at + size);
    return true;
}

bool take_zstd(Bytes bytes, std::span<std::byte> out) {
    ZSTD_DCtx* const context = decompressor();
    if (context == nullptr || ZSTD_findFrameCompressedSize(bytes.data(), bytes.size()) != bytes.size()) return false;
    const std::size_t size = ZSTD_decompressDCtx(context, out.data(), out.size(), bytes.data(), bytes.size());
    return is_good(size) && size == out.size();
}

std::optional<std::uint64_t> zstd_size(Bytes bytes) {
    const unsigned long long size = ZSTD_getFrameContentSize(bytes.data(), bytes.size());
    if (size == ZSTD_CONTENTSIZE_UNKNOWN || size == ZSTD_CONTENTSIZE_ERROR) return std::nullopt;
    return size;
}

#else

// check_encoded rejects everything that would be decoded here.
bool put_zstd(Bytes /*bytes*/, std::vector<std::byte>& /*out*/) {
    return false;
}
bool take_zstd(Bytes /*bytes*/, std::span<std::byte> /*out*/) {
    return false;
}
std::optional<std::uint64_t> zstd_size(Bytes /*bytes*/) {
    return std::nullopt;
}

#endif

namespace {

/// Splits numbers of `stride` bytes into byte planes: all first bytes, then all second ones; the remainder at the end
/// is unchanged.
void to_planes(Bytes numbers, std::size_t stride, std::span<std::byte> planes) {
    const std::size_t count = numbers.size() / stride;
    for (std::size_t n = 0; n < count; ++n) {
        for (std::size_t b = 0; b < stride; ++b) planes[b * count + n] = numbers[n * stride + b];
    }
    std::copy(numbers.begin() + static_cast<std::ptrdiff_t>(count * stride), numbers.end(),
              planes.begin() + static_cast<std::ptrdiff_t>(count * stride));
}

/// Restores numbers from planes. The width is a compile-time constant, so the compiler can use shuffles.
template <std::size_t Stride>
void interleave(const std::byte* planes, std::size_t count, std::byte* numbers) {
    for (std::size_t n = 0; n < count; ++n) {
        for (std::size_t b = 0; b < Stride; ++b) numbers[n * Stride + b] = planes[b * count + n];
    }
}

void from_planes(Bytes planes, std::size_t stride, std::span<std::byte> numbers) {
    const std::size_t count = numbers.size() / stride;
    if (stride == 2) {
        interleave<2>(planes.data(), count, numbers.data());
    } else if (stride == 4) {
        interleave<4>(planes.data(), count, numbers.data());
    } else if (stride == 8) {
        interleave<8>(planes.data(), count, numbers.data());
    } else {
        for (std::size_t n = 0; n < count; ++n) {
            for (std::size_t b = 0; b < stride; ++b) numbers[n * stride + b] = planes[b * count + n];
        }
    }
    std::copy(planes.begin() + static_cast<std::ptrdiff_t>(count * stride), planes.end(),
              numbers.begin() + static_cast<std::ptrdiff_t>(count * stride));
}

/// Adds a row's other u16 to its first, or subtracts them, modulo 65536.
void change_first(std::span<std::byte> row, bool add) {
    std::uint16_t first = 0;
    copy_at(row, 0, first);
    for (std::size_t at = sizeof first; at < row.size(); at += sizeof first) {
        std::uint16_t other = 0;
        copy_at(row, at, other);
        first = static_cast<std::uint16_t>(add ? first + other : first - other);
    }
    std::memcpy(row.data(), &first, sizeof first);
}

}  // namespace

bool decode_zstd(const CodecHeader& header, Bytes body, std::span<std::byte> out) {
    if (header.head != 0) return false;
    if (header.stride <= 1) return take_zstd(body, out);
    AlignedBytes planes(out.size());
    if (!take_zstd(body, planes.span())) return false;
    from_planes(planes.bytes(), header.stride, out);
    return true;
}

bool encode_zstd(const CodecHeader& header, Bytes payload, std::vector<std::byte>& out) {
    if (header.head != 0) return false;
    if (header.stride <= 1) return put_zstd(payload, out);
    AlignedBytes planes(payload.size());
    to_planes(payload, header.stride, planes.span());
    return put_zstd(planes.bytes(), out);
}

bool decode_sums(const CodecHeader& header, Bytes body, std::span<std::byte> out) {
    if (!take_head(header, body, out) || header.stride % 2 != 0) return false;
    const auto rows = count_of(out.size(), header.stride);
    if (!rows) return false;
    AlignedBytes planes(out.size());
    if (!take_zstd(body, planes.span())) return false;
    from_planes(planes.bytes(), header.stride, out);
    for (std::size_t row = 0; row < *rows; ++row) change_first(out.subspan(row * header.stride, header.stride), false);
    return true;
}

bool encode_sums(const CodecHeader& header, Bytes payload, std::vector<std::byte>& out) {
    if (header.head > payload.size() || header.stride % 2 != 0) return false;
    out.insert(out.end(), payload.begin(), payload.begin() + header.head);
    std::vector<std::byte> numbers(payload.begin() + header.head, payload.end());
    const auto rows = count_of(numbers.size(), header.stride);
    if (!rows) return false;
    for (std::size_t row = 0; row < *rows; ++row)
        change_first(std::span(numbers).subspan(row * header.stride, header.stride), true);
    std::vector<std::byte> planes(numbers.size());
    to_planes(numbers, header.stride, planes);
    return put_zstd(planes, out);
}

}  // namespace bendy
