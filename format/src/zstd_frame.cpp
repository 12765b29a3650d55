#include "zstd_frame.h"

#include <zstd.h>

namespace bendy {
namespace {

constexpr int kZstdLevel = 19;

}  // namespace

bool put_zstd(Bytes bytes, std::vector<std::byte>& out) {
    const std::size_t at = out.size();
    out.resize(at + ZSTD_compressBound(bytes.size()));
    const std::size_t size = ZSTD_compress(out.data() + at, out.size() - at, bytes.data(), bytes.size(), kZstdLevel);
    if (ZSTD_isError(size) != 0) return false;
    out.resize(at + size);
    return true;
}

bool take_zstd(Bytes bytes, std::span<std::byte> out) {
    const std::size_t size = ZSTD_decompress(out.data(), out.size(), bytes.data(), bytes.size());
    return ZSTD_isError(size) == 0 && size == out.size();
}

std::optional<std::uint64_t> zstd_size(Bytes bytes) {
    const unsigned long long size = ZSTD_getFrameContentSize(bytes.data(), bytes.size());
    if (size == ZSTD_CONTENTSIZE_UNKNOWN || size == ZSTD_CONTENTSIZE_ERROR) return std::nullopt;
    return size;
}

}  // namespace bendy
