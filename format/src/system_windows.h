#pragma once

#include <bendy/format/error.h>

#include <filesystem>
#include <string>
#include <utility>

#define WIN32_LEAN_AND_MEAN
#ifndef NOMINMAX
#define NOMINMAX
#endif
#include <windows.h>

namespace bendy {

/// \param number  of errno
Error error_of(ErrorCode code, int number);
/// Returns the error of GetLastError() as the equivalent errno number.
Error system_error(ErrorCode code);

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
std::wstring full_path(const std::filesystem::path& path);

}  // namespace bendy
