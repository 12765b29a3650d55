#include "codec_parts.h"

#ifndef BENDY_WITHOUT_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif

#include <algorithm>
#include <cstring>
#include <limits>
#include <mutex>

namespace bendy {

#ifndef BENDY_WITHOUT_MESHOPTIMIZER

namespace {

constexpr std::size_t kMostRowBytes = 256;
constexpr int kVertexVersion = 0;
constexpr int kIndexVersion = 1;
constexpr unsigned kVertexMark = 0xa0;
constexpr unsigned kIndexMark = 0xe0;

/// The library requires rows of whole 32-bit words.
std::size_t padded_row(std::size_t stride) {
    return (stride + 3) & ~std::size_t{3};
}

/// Calls decode(bytes) with the library's input: the body or, under zstd, its decompressed bytes, whose size is checked
/// against `most` before they are allocated.
template <class Decode>
bool with_unpacked(bool is_zstd, Bytes body, std::uint64_t most, const Decode& decode) {
    if (!is_zstd) return decode(body);
    const auto size = zstd_size(body);
    if (!size || *size > most) return false;
    AlignedBytes unpacked(*size);
    return take_zstd(body, unpacked.span()) && decode(unpacked.bytes());
}

/// Appends the library's output, compressed with zstd if requested.
bool put_packed(bool is_zstd, std::span<const unsigned char> packed, std::vector<std::byte>& out) {
    const Bytes bytes = std::as_bytes(packed);
    if (is_zstd) return put_zstd(bytes, out);
    out.insert(out.end(), bytes.begin(), bytes.end());
    return true;
}

/// Returns true if the library's bytes begin with `mark` and the version; the library would accept other versions, but
/// the format does not.
bool has_version(Bytes packed, unsigned mark, int version) {
    return !packed.empty() && std::to_integer<unsigned>(packed[0]) == (mark | static_cast<unsigned>(version));
}

const unsigned char* raw(Bytes bytes) {
    return reinterpret_cast<const unsigned char*>(bytes.data());  // NOLINT(*-reinterpret-cast)
}

/// meshoptimizer keeps the version to write in global variables: one thread at a time.
std::mutex& encoding() {
    static std::mutex mutex;
    return mutex;
}

std::optional<std::vector<unsigned char>> pack_triangles(std::span<const std::uint32_t> indices) {
    const std::size_t vertices =
        indices.empty() ? 0 : std::size_t{*std::max_element(indices.begin(), indices.end())} + 1;
    std::vector<unsigned char> packed(meshopt_encodeIndexBufferBound(indices.size(), vertices));
    const std::lock_guard lock(encoding());
    meshopt_encodeIndexVersion(kIndexVersion);
    const std::size_t size = meshopt_encodeIndexBuffer(packed.data(), packed.size(), indices.data(), indices.size());
    if (size == 0) return std::nullopt;
    packed.resize(size);
    return packed;
}

template <class T>
std::vector<std::uint32_t> widened(Bytes bytes) {
    const auto narrow = view_at<T>(bytes, 0, bytes.size() / sizeof(T));
    return {narrow.begin(), narrow.end()};
}

}  // namespace

bool decode_rows(const CodecHeader& header, bool is_zstd, Bytes body, std::span<std::byte> out) {
    if (!take_head(header, body, out) || header.stride > kMostRowBytes) return false;
    const auto rows = count_of(out.size(), header.stride);
    if (!rows) return false;
    const std::size_t wide = padded_row(header.stride);
    const auto decode = [&](Bytes packed) {
        if (!has_version(packed, kVertexMark, kVertexVersion)) return false;
        if (wide == header.stride)
            return meshopt_decodeVertexBuffer(out.data(), *rows, wide, raw(packed), packed.size()) == 0;
        AlignedBytes padded(*rows * wide);
        if (meshopt_decodeVertexBuffer(padded.span().data(), *rows, wide, raw(packed), packed.size()) != 0)
            return false;
        for (std::size_t row = 0; row < *rows; ++row)
            std::memcpy(out.data() + row * header.stride, padded.bytes().data() + row * wide, header.stride);
        return true;
    };
    return with_unpacked(is_zstd, body, meshopt_encodeVertexBufferBound(*rows, wide), decode);
}

bool encode_rows(const CodecHeader& header, bool is_zstd, Bytes payload, std::vector<std::byte>& out) {
    if (header.head > payload.size() || header.stride > kMostRowBytes) return false;
    out.insert(out.end(), payload.begin(), payload.begin() + header.head);
    const Bytes rest = payload.subspan(header.head);
    const auto rows = count_of(rest.size(), header.stride);
    if (!rows) return false;
    const std::size_t wide = padded_row(header.stride);
    std::vector<std::byte> padded(*rows * wide);
    for (std::size_t row = 0; row < *rows; ++row)
        std::memcpy(padded.data() + row * wide, rest.data() + row * header.stride, header.stride);
    std::vector<unsigned char> packed(meshopt_encodeVertexBufferBound(*rows, wide));
    const std::lock_guard lock(encoding());
    meshopt_encodeVertexVersion(kVertexVersion);
    const std::size_t size = meshopt_encodeVertexBuffer(packed.data(), packed.size(), padded.data(), *rows, wide);
    if (size == 0) return false;
    return put_packed(is_zstd, std::span(packed).first(size), out);
}

bool decode_triangles(const CodecHeader& header, bool is_zstd, Bytes body, std::span<std::byte> out) {
    if (!take_head(header, body, out) || (header.stride != 2 && header.stride != 4)) return false;
    const auto triangles = count_of(out.size(), std::size_t{3} * header.stride);
    if (!triangles) return false;
    const std::size_t count = *triangles * 3;
    const auto decode = [&](Bytes packed) {
        if (!has_version(packed, kIndexMark, kIndexVersion)) return false;
        AlignedBytes indices(out.size());
        if (meshopt_decodeIndexBuffer(indices.span().data(), count, header.stride, raw(packed), packed.size()) != 0)
            return false;
        std::copy(indices.bytes().begin(), indices.bytes().end(), out.begin());
        return true;
    };
    constexpr std::size_t kMostVertices = std::numeric_limits<std::uint32_t>::max();
    return with_unpacked(is_zstd, body, meshopt_encodeIndexBufferBound(count, kMostVertices), decode);
}

bool encode_triangles(const CodecHeader& header, bool is_zstd, Bytes payload, std::vector<std::byte>& out) {
    if (header.head > payload.size() || (header.stride != 2 && header.stride != 4)) return false;
    const Bytes list = payload.subspan(header.head);
    if (!count_of(list.size(), std::size_t{3} * header.stride)) return false;
    const std::vector<std::byte> aligned(list.begin(), list.end());
    const auto packed =
        pack_triangles(header.stride == 2 ? widened<std::uint16_t>(aligned) : widened<std::uint32_t>(aligned));
    if (!packed) return false;
    AlignedBytes decoded(list.size());
    const int failed = meshopt_decodeIndexBuffer(decoded.span().data(), list.size() / header.stride, header.stride,
                                                 packed->data(), packed->size());
    if (failed != 0 || !std::equal(list.begin(), list.end(), decoded.bytes().begin())) return false;
    out.insert(out.end(), payload.begin(), payload.begin() + header.head);
    return put_packed(is_zstd, *packed, out);
}

std::optional<std::vector<std::uint32_t>> canonical_triangles(std::span<const std::uint32_t> indices) {
    constexpr int kMostTurns = 8;
    if (indices.size() % 3 != 0) return std::nullopt;
    std::vector<std::uint32_t> list(indices.begin(), indices.end());
    for (int turn = 0; turn < kMostTurns; ++turn) {
        const auto packed = pack_triangles(list);
        std::vector<std::uint32_t> decoded(list.size());
        if (!packed || meshopt_decodeIndexBuffer(decoded.data(), decoded.size(), sizeof(std::uint32_t), packed->data(),
                                                 packed->size()) != 0)
            return std::nullopt;
        if (decoded == list) return list;
        list = std::move(decoded);
    }
    return std::nullopt;
}

#else

// check_encoded rejects everything that would be decoded here.
bool decode_rows(const CodecHeader& /*header*/, bool /*is_zstd*/, Bytes /*body*/, std::span<std::byte> /*out*/) {
    return false;
}
bool encode_rows(const CodecHeader& /*header*/, bool /*is_zstd*/, Bytes /*payload*/, std::vector<std::byte>& /*out*/) {
    return false;
}
bool decode_triangles(const CodecHeader& /*header*/, bool /*is_zstd*/, Bytes /*body*/, std::span<std::byte> /*out*/) {
    return false;
}
bool encode_triangles(const CodecHeader& /*header*/, bool /*is_zstd*/, Bytes /*payload*/,
                      std::vector<std::byte>& /*out*/) {
    return false;
}

#endif

}  // namespace bendy
