#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/format/public.h>
#include <bendy/format/result.h>

#include <cstddef>
#include <filesystem>

namespace BENDY_PUBLIC bendy {

/// A file mapped read-only into memory; an empty file gives an empty view. The bytes start on a page boundary.
///
/// While a file is mapped, POSIX systems allow it to be replaced or removed: the bytes stay unchanged. (Writing into
/// the file in place does change them.) Windows does not allow it to be written, replaced, renamed or removed; other
/// programs may read it.
class MappedFile {
public:
    static Result<MappedFile> open(const std::filesystem::path& path);

    MappedFile() = default;
    MappedFile(MappedFile&& other) noexcept;
    MappedFile& operator=(MappedFile&& other) noexcept;
    MappedFile(const MappedFile&) = delete;
    MappedFile& operator=(const MappedFile&) = delete;
    ~MappedFile();

    [[nodiscard]] Bytes bytes() const { return {data_, size_}; }

private:
    const std::byte* data_ = nullptr;
    std::size_t size_ = 0;
    [[maybe_unused]] void* file_ = nullptr;  ///< Windows: the handle that keeps other programs from changing the file
};

/// Writes a whole file or nothing: into a new file beside `path`, flushed to disk, then renamed over it. On failure the
/// old file, if there was one, is untouched, and the new one is removed. If `path` is a symbolic link, the file that it
/// points to is replaced, not the link; a pipe or a device, such as /dev/stdout, is written to directly. On Windows a
/// file that is open elsewhere, for example mapped, cannot be replaced: kCannotWrite with EBUSY.
///
/// Paths of both functions may contain any characters, and on Windows be longer than 260. The value of an error is an
/// errno number on all systems.
Result<void> write_file(const std::filesystem::path& path, Bytes bytes);

}  // namespace bendy
