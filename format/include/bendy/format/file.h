#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/format/public.h>
#include <bendy/format/result.h>

#include <cstddef>
#include <filesystem>

namespace BENDY_PUBLIC bendy {

/// A file mapped read-only into memory; an empty file gives an empty view. The bytes start on a page boundary.
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
};

/// Writes a whole file or nothing: into a new file beside `path`, flushed to the disk, then renamed over it. On failure
/// the old file, if there was one, is untouched and no new one is left behind.
Result<void> write_file(const std::filesystem::path& path, Bytes bytes);

}  // namespace bendy
