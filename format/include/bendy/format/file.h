#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/format/public.h>
#include <bendy/format/result.h>

#include <cstddef>
#include <filesystem>

namespace BENDY_PUBLIC bendy {

/// A file mapped read-only into memory; an empty file gives an empty view. The bytes start on a page boundary.
///
/// While a file is mapped, POSIX systems let others replace or remove it: the bytes stay what they were. (Who writes
/// into it changes them.) Windows refuses to let it be written, replaced, renamed or removed; other readers are
/// welcome.
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
    [[maybe_unused]] void* file_ = nullptr;  ///< Windows: the handle that keeps others from changing the file
};

/// Writes a whole file or nothing: into a new file beside `path`, flushed to the disk, then renamed over it. On failure
/// the old file, if there was one, is untouched and no new one is left behind. What a link names is replaced, not the
/// link; a pipe or a device, such as /dev/stdout, is written to as it is. On Windows a file that is open elsewhere,
/// mapped for one, cannot be replaced: kCannotWrite with EBUSY.
///
/// Paths of both functions may have any characters, and on Windows more than 260. An error's value is an errno number
/// on all systems.
Result<void> write_file(const std::filesystem::path& path, Bytes bytes);

}  // namespace bendy
