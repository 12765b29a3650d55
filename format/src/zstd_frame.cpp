#include "zstd_frame.h"

#include <zstd.h>
#include <zstd_errors.h>

#include <limits>
#include <memory>
#include <new>

namespace bendy {
namespace {

constexpr int kZstdLevel = 19;

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

/// One per thread, and kept: creating one queries the processor, which takes tens of microseconds in virtual machines,
/// and a file may have hundreds of frames.
ZSTD_DCtx* decompressor() {
    struct Free {
        void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
    };
    thread_local std::unique_ptr<ZSTD_DCtx, Free> context;
    if (context == nullptr) context.reset(ZSTD_createDCtx());
    if (context == nullptr) fail_as_allocation();
    return context.get();
}

}  // namespace

bool put_zstd(Bytes bytes, std::vector<std::byte>& out) {
    const std::size_t at = out.size();
    out.resize(at + ZSTD_compressBound(bytes.size()));
    const std::size_t size = ZSTD_compress(out.data() + at, out.size() - at, bytes.data(), bytes.size(), kZstdLevel);
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

}  // namespace bendy
