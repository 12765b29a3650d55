#pragma once

#include "check.h"

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <filesystem>
#include <string>

namespace bendy::fuzz {

/// A file without a place on the disk.
class MemoryFile {
public:
    MemoryFile(const void* data, std::size_t size) : descriptor_(memfd_create("fuzz", 0)) {
        check(descriptor_ >= 0 && write(descriptor_, data, size) == static_cast<ssize_t>(size), "a file in memory");
    }
    ~MemoryFile() { close(descriptor_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    [[nodiscard]] std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

private:
    int descriptor_;
};

}  // namespace bendy::fuzz
