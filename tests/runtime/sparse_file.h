#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>

#ifdef _WIN32
#define WIN32_LEAN_AND_MEAN
#ifndef NOMINMAX
#define NOMINMAX
#endif
#include <windows.h>

#include <winioctl.h>
#else
#include <sys/stat.h>
#endif

namespace bendy::test {

/// Makes an empty file in which holes take no room, where the system knows such files.
inline void make_sparse_file(const std::filesystem::path& path) {
    std::ofstream(path, std::ios::binary).flush();
#ifdef _WIN32
    const HANDLE file = ::CreateFileW(path.c_str(), GENERIC_WRITE, 0, nullptr, OPEN_EXISTING, 0, nullptr);
    DWORD unused = 0;
    ::DeviceIoControl(file, FSCTL_SET_SPARSE, nullptr, 0, nullptr, 0, &unused, nullptr);
    ::CloseHandle(file);
#endif
}

/// What a file takes on the disk, in bytes.
inline std::uint64_t room_of(const std::filesystem::path& path) {
#ifdef _WIN32
    DWORD high = 0;
    const DWORD low = ::GetCompressedFileSizeW(path.c_str(), &high);
    return std::uint64_t{high} << 32 | low;
#else
    struct stat status {};
    constexpr std::uint64_t kBlock = 512;
    return ::stat(path.c_str(), &status) == 0 ? static_cast<std::uint64_t>(status.st_blocks) * kBlock : UINT64_MAX;
#endif
}

}  // namespace bendy::test
