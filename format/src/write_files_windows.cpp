#include "system_windows.h"
#include "write_files.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <string>
#include <utility>

namespace bendy {
namespace {

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

}  // namespace

Result<void> stage(const FileContents& contents, StagedFile& staged) {
    const Target target = find_target(contents.path);  // the target of a symbolic link, not the link
    if (target.path.empty()) return error_of(ErrorCode::kCannotWrite, ENOENT);
    if (target.is_folder) return error_of(ErrorCode::kCannotWrite, EISDIR);
    staged.target = target.path;
    HANDLE handle = INVALID_HANDLE_VALUE;
    do {
        staged.beside = name_beside(staged.target);
        // FILE_SHARE_DELETE: so that remove_temporary_files() may remove it.
        handle = ::CreateFileW(staged.beside->path().c_str(), GENERIC_WRITE, FILE_SHARE_DELETE, nullptr, CREATE_NEW,
                               FILE_ATTRIBUTE_NORMAL, nullptr);
    } while (handle == INVALID_HANDLE_VALUE && ::GetLastError() == ERROR_FILE_EXISTS);
    Handle file(handle);
    if (!file.is_open()) {
        const Error error = last_error();
        staged.beside.reset();
        return error;
    }
    if (write_all(file.get(), contents.bytes) && ::FlushFileBuffers(file.get()) != 0 && file.close()) return {};
    const Error error = last_error();
    if (file.is_open()) static_cast<void>(file.close());  // an open file cannot be deleted
    ::DeleteFileW(staged.beside->path().c_str());
    staged.beside.reset();
    return error;
}

bool keep_old(StagedFile& staged) {
    if (::CreateHardLinkW(staged.kept->path().c_str(), staged.target.c_str(), nullptr) != 0) return true;
    if (::GetLastError() != ERROR_FILE_NOT_FOUND &&  // some file systems have no hard links
        ::MoveFileExW(staged.target.c_str(), staged.kept->path().c_str(), MOVEFILE_WRITE_THROUGH) != 0)
        return true;
    staged.kept.reset();
    return ::GetLastError() == ERROR_FILE_NOT_FOUND;
}

bool replace(const std::filesystem::path& target, const std::filesystem::path& by) {
    if (::MoveFileExW(by.c_str(), target.c_str(), MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH) != 0) return true;
    const DWORD reason = ::GetLastError();
    // Distinguishes whether another program has the target open from missing rights.
    const Handle open(::CreateFileW(target.c_str(), DELETE, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE,
                                    nullptr, OPEN_EXISTING, 0, nullptr));
    if (open.is_open() || ::GetLastError() != ERROR_SHARING_VIOLATION) ::SetLastError(reason);
    return false;
}

Error last_error() {
    return system_error(ErrorCode::kCannotWrite);
}

unsigned long process_number() {
    return ::GetCurrentProcessId();
}

void remove_at_once(const wchar_t* name) noexcept {
    ::DeleteFileW(name);
}

void wait_briefly() noexcept {
    ::Sleep(1);
}

struct SignalsBlocked::State {};

// Windows runs handlers on threads of their own.
SignalsBlocked::SignalsBlocked() = default;
SignalsBlocked::~SignalsBlocked() = default;

}  // namespace bendy
