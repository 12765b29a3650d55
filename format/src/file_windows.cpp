#include "system_windows.h"

#include <bendy/format/file.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace bendy {
namespace {

struct Meaning {
    DWORD system;
    int number;
};

/// The errno equivalents of Windows errors, so that they read the same on all systems.
constexpr std::array<Meaning, 22> kMeanings{{
    {ERROR_FILE_NOT_FOUND, ENOENT},      {ERROR_PATH_NOT_FOUND, ENOENT},
    {ERROR_INVALID_NAME, ENOENT},        {ERROR_BAD_PATHNAME, ENOENT},
    {ERROR_BAD_NETPATH, ENOENT},         {ERROR_INVALID_DRIVE, ENOENT},
    {ERROR_DIRECTORY, ENOTDIR},          {ERROR_FILENAME_EXCED_RANGE, ENAMETOOLONG},
    {ERROR_ACCESS_DENIED, EACCES},       {ERROR_SHARING_VIOLATION, EBUSY},
    {ERROR_LOCK_VIOLATION, EBUSY},       {ERROR_USER_MAPPED_FILE, EBUSY},
    {ERROR_WRITE_PROTECT, EROFS},        {ERROR_DISK_FULL, ENOSPC},
    {ERROR_HANDLE_DISK_FULL, ENOSPC},    {ERROR_FILE_TOO_LARGE, EFBIG},
    {ERROR_FILE_EXISTS, EEXIST},         {ERROR_ALREADY_EXISTS, EEXIST},
    {ERROR_TOO_MANY_OPEN_FILES, EMFILE}, {ERROR_NOT_ENOUGH_MEMORY, ENOMEM},
    {ERROR_OUTOFMEMORY, ENOMEM},         {ERROR_COMMITMENT_LIMIT, ENOMEM},
}};

int number_of(DWORD system) {
    for (const Meaning& meaning : kMeanings) {
        if (meaning.system == system) return meaning.number;
    }
    return EIO;
}

}  // namespace

Error error_of(ErrorCode code, int number) {
    return {code, 0, static_cast<std::uint64_t>(number)};
}

Error system_error(ErrorCode code) {
    return error_of(code, number_of(::GetLastError()));
}

std::wstring full_path(const std::filesystem::path& path) {
    std::wstring full(::GetFullPathNameW(path.c_str(), 0, nullptr, nullptr), L'\0');  // including the final zero
    full.resize(::GetFullPathNameW(path.c_str(), static_cast<DWORD>(full.size()), full.data(), nullptr));
    if (full.empty()) return full;
    const std::wstring_view start = std::wstring_view(full).substr(0, 4);
    if (start == LR"(\\?\)" || start == LR"(\\.\)") return full;
    if (start.starts_with(LR"(\\)")) return LR"(\\?\UNC)" + full.substr(1);
    return LR"(\\?\)" + full;
}

namespace {

/// Opens a file that other programs may not write or delete meanwhile. \param size  receives its size
Result<HANDLE> open_to_read(const std::filesystem::path& path, std::size_t& size) {
    // Folders are opened only to report what they are.
    Handle file(::CreateFileW(full_path(path).c_str(), GENERIC_READ, FILE_SHARE_READ, nullptr, OPEN_EXISTING,
                              FILE_FLAG_BACKUP_SEMANTICS, nullptr));
    if (!file.is_open()) return system_error(ErrorCode::kCannotOpen);
    if (::GetFileType(file.get()) != FILE_TYPE_DISK) return error_of(ErrorCode::kCannotRead, EINVAL);
    BY_HANDLE_FILE_INFORMATION status{};
    if (::GetFileInformationByHandle(file.get(), &status) == 0) return system_error(ErrorCode::kCannotRead);
    if ((status.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) != 0) return error_of(ErrorCode::kCannotRead, EISDIR);
    const std::uint64_t whole = std::uint64_t{status.nFileSizeHigh} << 32 | status.nFileSizeLow;
    if (whole > SIZE_MAX) return error_of(ErrorCode::kCannotRead, ENOMEM);
    size = static_cast<std::size_t>(whole);
    return file.release();
}

}  // namespace

Result<MappedFile> MappedFile::open(const std::filesystem::path& path) {
    MappedFile mapped;
    const auto opened = open_to_read(path, mapped.size_);
    if (!opened) return opened.error();
    Handle file(*opened);
    if (mapped.size_ == 0) return mapped;
    const Handle mapping(::CreateFileMappingW(file.get(), nullptr, PAGE_READONLY, 0, 0, nullptr));
    if (!mapping.is_open()) return system_error(ErrorCode::kCannotRead);
    const void* const data = ::MapViewOfFile(mapping.get(), FILE_MAP_READ, 0, 0, mapped.size_);
    if (data == nullptr) return system_error(ErrorCode::kCannotRead);
    mapped.data_ = static_cast<const std::byte*>(data);
    mapped.file_ = file.release();
    return mapped;
}

Result<MappedFile> MappedFile::read(const std::filesystem::path& path) {
    MappedFile copy;
    const auto opened = open_to_read(path, copy.size_);
    if (!opened) return opened.error();
    const Handle file(*opened);
    if (copy.size_ == 0) return copy;
    void* const data = ::VirtualAlloc(nullptr, copy.size_, MEM_RESERVE | MEM_COMMIT, PAGE_READWRITE);
    if (data == nullptr) return system_error(ErrorCode::kCannotRead);
    auto* const bytes = static_cast<std::byte*>(data);
    copy.data_ = bytes;
    for (std::size_t at = 0; at < copy.size_;) {
        constexpr std::size_t kMostAtOnce = std::size_t{1} << 30;
        DWORD got = 0;
        const auto wanted = static_cast<DWORD>(std::min(copy.size_ - at, kMostAtOnce));
        if (::ReadFile(file.get(), bytes + at, wanted, &got, nullptr) == 0) return system_error(ErrorCode::kCannotRead);
        if (got == 0) return error_of(ErrorCode::kCannotRead, EBUSY);
        at += got;
    }
    return copy;
}

MappedFile::MappedFile(MappedFile&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)),
      size_(std::exchange(other.size_, 0)),
      file_(std::exchange(other.file_, nullptr)) {}

MappedFile& MappedFile::operator=(MappedFile&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    std::swap(file_, other.file_);
    return *this;
}

MappedFile::~MappedFile() {
    if (data_ == nullptr) return;
    if (file_ == nullptr) {
        ::VirtualFree(const_cast<std::byte*>(data_), 0, MEM_RELEASE);  // NOLINT(*-const-cast): its signature
    } else {
        ::UnmapViewOfFile(data_);
        ::CloseHandle(file_);
    }
}

const char* mapped_file_at(const void* /*address*/) noexcept {
    return nullptr;
}

}  // namespace bendy
