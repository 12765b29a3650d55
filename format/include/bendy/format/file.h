#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/format/public.h>
#include <bendy/format/result.h>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

namespace BENDY_PUBLIC bendy {

/// A file mapped read-only into memory, or read into it; an empty file gives an empty view. The bytes start on a page
/// boundary.
///
/// While a file is mapped, POSIX systems allow it to be replaced or removed: the bytes stay unchanged. Writing into the
/// file in place does change them, and after it was made shorter, reading past its new end raises SIGBUS, which ends
/// the program. Windows does not allow a mapped file to be written, replaced, renamed or removed; other programs may
/// read it.
class MappedFile {
public:
    static Result<MappedFile> open(const std::filesystem::path& path);
    /// Reads the file into memory of its own: whatever happens to the file afterwards, the bytes stay. If the file is
    /// made shorter meanwhile, the error is kCannotRead with EBUSY.
    static Result<MappedFile> read(const std::filesystem::path& path);

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
    void* file_ = nullptr;  ///< if mapped: its entry for mapped_file_at(); on Windows, the handle that keeps others out
};

/// For a handler of SIGBUS: returns the name of the file that is mapped at the address, as the bytes that
/// MappedFile::open was given; null if there is none, and always on Windows. Safe in signal handlers; the text lives as
/// long as the mapping.
const char* mapped_file_at(const void* address) noexcept;

/// Writes a whole file or nothing: into a new file beside `path`, flushed to disk, then renamed over it. On failure the
/// old file, if there was one, is untouched, and the new one is removed. If `path` is a symbolic link, the file that it
/// points to is replaced, not the link; a pipe or a device, such as /dev/stdout, is written to directly. On Windows a
/// file that is open elsewhere, for example mapped, cannot be replaced: kCannotWrite with EBUSY. On POSIX systems the
/// new file has the mode of the old one, and its owner and group where the user may set them.
///
/// Paths of all functions may contain any characters, and on Windows be longer than 260. The value of an error is an
/// errno number on all systems.
Result<void> write_file(const std::filesystem::path& path, Bytes bytes);

struct FileContents {
    std::filesystem::path path;
    Bytes bytes;
};

struct WriteFailure {
    std::size_t file = 0;  ///< index of the file that could not be written
    Error error;
};

/// Files that are written one after another, each as write_file does, and replace the old ones together or not at all:
/// all are flushed to disk before the first is renamed, and if a rename fails, the old files are put back. Only if the
/// program is killed between two renames, or the machine stops, are some files new and others old; the old ones are
/// then beside them as `.bendy-*`. Holds names only, neither contents nor open files, so there may be any number.
class FileSet {
public:
    FileSet();
    FileSet(const FileSet&) = delete;
    FileSet& operator=(const FileSet&) = delete;
    FileSet(FileSet&&) = delete;
    FileSet& operator=(FileSet&&) = delete;
    /// Removes what was written but has not replaced anything.
    ~FileSet();

    /// Writes a new file beside its target; a pipe or a device is written to directly.
    Result<void> write(const FileContents& file);
    /// Replaces the old files. The set is empty afterwards, in any case. `WriteFailure::file` counts calls of write.
    Result<void, WriteFailure> replace();

private:
    struct Files;
    std::unique_ptr<Files> files_;
};

/// Writes several files that replace the old ones together or not at all: see FileSet.
Result<void, WriteFailure> write_files(std::span<const FileContents> files);

/// For a handler of signals that end the program: removes the temporary files of the functions above on all threads.
/// Waits until files that are being replaced together are all replaced. Safe in signal handlers on any thread;
/// afterwards nothing can be written.
void remove_temporary_files() noexcept;

}  // namespace bendy
