#include "files/output.h"

#define WIN32_LEAN_AND_MEAN
#ifndef NOMINMAX
#define NOMINMAX
#endif
#include <windows.h>

namespace bendy::tools {
namespace {

std::optional<FileIdentity> identity(HANDLE file) {
    BY_HANDLE_FILE_INFORMATION status{};
    if (file == nullptr || file == INVALID_HANDLE_VALUE || ::GetFileType(file) != FILE_TYPE_DISK ||
        ::GetFileInformationByHandle(file, &status) == 0)
        return std::nullopt;
    return FileIdentity{status.dwVolumeSerialNumber,
                        std::uint64_t{status.nFileIndexHigh} << 32u | status.nFileIndexLow};
}

}  // namespace

std::optional<FileIdentity> identity_of(const std::filesystem::path& file) {
    // Requests no access, so that it works for files that are open elsewhere; the flag allows opening folders.
    HANDLE handle = ::CreateFileW(file.c_str(), 0, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, nullptr,
                                  OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, nullptr);
    const auto found = identity(handle);
    if (handle != INVALID_HANDLE_VALUE) ::CloseHandle(handle);
    return found;
}

std::optional<FileIdentity> identity_of_standard_input() {
    return identity(::GetStdHandle(STD_INPUT_HANDLE));
}

std::optional<FileIdentity> identity_of_standard_output() {
    return identity(::GetStdHandle(STD_OUTPUT_HANDLE));
}

}  // namespace bendy::tools
