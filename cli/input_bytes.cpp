#include "input_bytes.h"

#include "problem.h"

#include <bendy/format/diagnostics.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <new>
#include <utility>

namespace bendy::cli {
namespace {

Error cannot_read(int number) {
    return {ErrorCode::kCannotRead, 0, static_cast<std::uint64_t>(number)};
}

Result<std::vector<std::byte>> read_standard_input() {
    static bool was_read = false;
    if (std::exchange(was_read, true)) fail("-", "can be read only once: give one of the files by name");
    std::vector<std::byte> bytes;
    std::size_t size = 0;
    constexpr std::size_t kFirst = std::size_t{1} << 16;
    while (true) {
        // One byte past the limit tells a file of just that size from a longer one.
        if (size == bytes.size()) bytes.resize(std::clamp<std::size_t>(2 * size, kFirst, InputBytes::kMostPiped + 1));
        const std::size_t got = std::fread(bytes.data() + size, 1, bytes.size() - size, stdin);
        size += got;
        if (size > InputBytes::kMostPiped) return cannot_read(EFBIG);
        if (std::ferror(stdin) != 0) return cannot_read(errno);
        if (got == 0) break;
    }
    bytes.resize(size);
    return bytes;
}

}  // namespace

Result<InputBytes> InputBytes::open(const std::filesystem::path& file) {
    InputBytes input;
    if (!is_dash(file)) {
        Result<MappedFile> mapped = MappedFile::open(file);
        if (!mapped) return mapped.error();
        input.mapped_ = *std::move(mapped);
        return input;
    }
    try {
        auto piped = read_standard_input();
        if (!piped) return piped.error();
        input.piped_ = *std::move(piped);
    } catch (const std::bad_alloc&) {
        return cannot_read(ENOMEM);
    }
    input.is_piped_ = true;
    return input;
}

InputBytes InputBytes::read(const std::filesystem::path& file) {
    Result<InputBytes> input = open(file);
    if (!input) fail(file, describe(input.error()));
    return *std::move(input);
}

std::vector<std::byte> InputBytes::take() && {
    if (is_piped_) return std::move(piped_);
    return {mapped_.bytes().begin(), mapped_.bytes().end()};
}

}  // namespace bendy::cli
