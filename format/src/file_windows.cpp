#include <bendy/format/file.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#define WIN32_LEAN_AND_MEAN
#ifndef NOMINMAX
#define NOMINMAX
#endif
#include <windows.h>

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

Error error_of(ErrorCode code, int number) {
    return {code, 0, static_cast<std::uint64_t>(number)};
}

Error system_error(ErrorCode code) {
    return error_of(code, number_of(::GetLastError()));
}

/// A handle that closes itself.
class Handle {
public:
    explicit Handle(HANDLE handle) : handle_(handle) {}
    ~Handle() {
        if (is_open()) ::CloseHandle(handle_);
    }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    Handle(Handle&&) = delete;
    Handle& operator=(Handle&&) = delete;
    [[nodiscard]] bool is_open() const { return handle_ != INVALID_HANDLE_VALUE && handle_ != nullptr; }
    [[nodiscard]] HANDLE get() const { return handle_; }
    [[nodiscard]] HANDLE release() { return std::exchange(handle_, INVALID_HANDLE_VALUE); }
    [[nodiscard]] bool close() { return ::CloseHandle(release()) != 0; }

private:
    HANDLE handle_;
};

/// Returns the absolute path with the prefix that lifts the limit of 260 characters; empty if there is none.
std::wstring full_path(const std::filesystem::path& path) {
    std::wstring full(::GetFullPathNameW(path.c_str(), 0, nullptr, nullptr), L'\0');  // including the final zero
    full.resize(::GetFullPathNameW(path.c_str(), static_cast<DWORD>(full.size()), full.data(), nullptr));
    if (full.empty()) return full;
    const std::wstring_view start = std::wstring_view(full).substr(0, 4);
    if (start == LR"(\\?\)" || start == LR"(\\.\)") return full;
    if (start.starts_with(LR"(\\)")) return LR"(\\?\UNC)" + full.substr(1);
    return LR"(\\?\)" + full;
}

/// The target of a path.
struct Target {
    bool is_folder = false;
    std::wstring path;
};

Target find_target(const std::filesystem::path& path) {
    Target target{false, full_path(path)};
    const Handle file(::CreateFileW(target.path.c_str(), 0, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE,
                                    nullptr, OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, nullptr));
    BY_HANDLE_FILE_INFORMATION status{};
    if (!file.is_open() || ::GetFileInformationByHandle(file.get(), &status) == 0) return target;
    target.is_folder = (status.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) != 0;
    if ((::GetFileAttributesW(target.path.c_str()) & FILE_ATTRIBUTE_REPARSE_POINT) == 0) return target;
    constexpr DWORD kLongest = 32768;
    std::wstring linked(kLongest, L'\0');
    linked.resize(::GetFinalPathNameByHandleW(file.get(), linked.data(), kLongest, FILE_NAME_NORMALIZED));
    if (!linked.empty()) target.path = std::move(linked);
    return target;
}

bool write_all(HANDLE file, Bytes bytes) {
    while (!bytes.empty()) {
        constexpr std::size_t kMostAtOnce = std::size_t{1} << 30;
        DWORD written = 0;
        if (::WriteFile(file, bytes.data(), static_cast<DWORD>(std::min(bytes.size(), kMostAtOnce)), &written,
                        nullptr) == 0)
            return false;
        if (written == 0) {
            ::SetLastError(ERROR_DISK_FULL);
            return false;
        }
        bytes = bytes.subspan(written);
    }
    return true;
}

/// Replaces a file by another, completely or not at all.
bool replace(const std::wstring& target, const std::wstring& by) {
    if (::MoveFileExW(by.c_str(), target.c_str(), MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH) != 0) return true;
    const DWORD reason = ::GetLastError();
    // Distinguishes whether another program has the target open from missing rights.
    const Handle open(::CreateFileW(target.c_str(), DELETE, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE,
                                    nullptr, OPEN_EXISTING, 0, nullptr));
    if (open.is_open() || ::GetLastError() != ERROR_SHARING_VIOLATION) ::SetLastError(reason);
    return false;
}

}  // namespace

Result<MappedFile> MappedFile::open(const std::filesystem::path& path) {
    // Folders are opened only to report what they are. Other programs may not write or delete the file while it is
    // mapped.
    Handle file(::CreateFileW(full_path(path).c_str(), GENERIC_READ, FILE_SHARE_READ, nullptr, OPEN_EXISTING,
                              FILE_FLAG_BACKUP_SEMANTICS, nullptr));
    if (!file.is_open()) return system_error(ErrorCode::kCannotOpen);
    if (::GetFileType(file.get()) != FILE_TYPE_DISK) return error_of(ErrorCode::kCannotRead, EINVAL);
    BY_HANDLE_FILE_INFORMATION status{};
    if (::GetFileInformationByHandle(file.get(), &status) == 0) return system_error(ErrorCode::kCannotRead);
    if ((status.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) != 0) return error_of(ErrorCode::kCannotRead, EISDIR);
    MappedFile mapped;
    const std::uint64_t size = std::uint64_t{status.nFileSizeHigh} << 32 | status.nFileSizeLow;
    if (size == 0) return mapped;
    if (size > SIZE_MAX) return error_of(ErrorCode::kCannotRead, ENOMEM);
    const Handle mapping(
        ::CreateFileMappingW(file.get(), nullptr, PAGE_READONLY, status.nFileSizeHigh, status.nFileSizeLow, nullptr));
    if (!mapping.is_open()) return system_error(ErrorCode::kCannotRead);
    const void* const data = ::MapViewOfFile(mapping.get(), FILE_MAP_READ, 0, 0, static_cast<std::size_t>(size));
    if (data == nullptr) return system_error(ErrorCode::kCannotRead);
    mapped.data_ = static_cast<const std::byte*>(data);
    mapped.size_ = static_cast<std::size_t>(size);
    mapped.file_ = file.release();
    return mapped;
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
    if (data_ != nullptr) ::UnmapViewOfFile(data_);
    if (file_ != nullptr) ::CloseHandle(file_);
}

Result<void> write_file(const std::filesystem::path& path, Bytes bytes) {
    const Target target = find_target(path);  // the target of a symbolic link, not the link
    if (target.path.empty()) return error_of(ErrorCode::kCannotWrite, ENOENT);
    if (target.is_folder) return error_of(ErrorCode::kCannotWrite, EISDIR);

    // The name is short, so that a target with the longest possible name can be written, and new, so that no existing
    // file is overwritten.
    static std::atomic<unsigned> counter{0};
    const std::wstring folder = target.path.substr(0, target.path.find_last_of(L'\\') + 1);
    std::wstring beside;
    HANDLE handle = INVALID_HANDLE_VALUE;
    do {
        beside = folder + L".bendy-" + std::to_wstring(::GetCurrentProcessId()) + L'-' + std::to_wstring(counter++);
        handle = ::CreateFileW(beside.c_str(), GENERIC_WRITE, 0, nullptr, CREATE_NEW, FILE_ATTRIBUTE_NORMAL, nullptr);
    } while (handle == INVALID_HANDLE_VALUE && ::GetLastError() == ERROR_FILE_EXISTS);
    Handle file(handle);
    if (!file.is_open()) return system_error(ErrorCode::kCannotWrite);
    const bool written = write_all(file.get(), bytes) && ::FlushFileBuffers(file.get()) != 0 && file.close() &&
                         replace(target.path, beside);
    if (written) return {};
    const Error error = system_error(ErrorCode::kCannotWrite);
    if (file.is_open()) static_cast<void>(file.close());  // an open file cannot be deleted
    ::DeleteFileW(beside.c_str());
    return error;
}

}  // namespace bendy
