#include "zstd_frame.h"

#include <zstd.h>

#include <memory>

namespace bendy {
namespace {

constexpr int kZstdLevel = 19;

/// The thread's own, kept: making one asks the processor what it is, which takes tens of microseconds in virtual
/// machines, and a file may have hundreds of frames.
ZSTD_DCtx* decompressor() {
    struct Free {
        void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
    };
    thread_local const std::unique_ptr<ZSTD_DCtx, Free> context(ZSTD_createDCtx());
    return context.get();
}

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
    ZSTD_DCtx* const context = decompressor();
    if (context == nullptr) return false;
    const std::size_t size = ZSTD_decompressDCtx(context, out.data(), out.size(), bytes.data(), bytes.size());
    return ZSTD_isError(size) == 0 && size == out.size();
}

std::optional<std::uint64_t> zstd_size(Bytes bytes) {
    const unsigned long long size = ZSTD_getFrameContentSize(bytes.data(), bytes.size());
    if (size == ZSTD_CONTENTSIZE_UNKNOWN || size == ZSTD_CONTENTSIZE_ERROR) return std::nullopt;
    return size;
}

}  // namespace bendy
