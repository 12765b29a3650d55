#pragma once

#include <bendy/format/byte_reader.h>

#include <cstdint>
#include <span>

// The implementations of crc32c, which uses the first one that the machine can run.
namespace bendy {

struct Crc32cKernel {
    const char* name;
    bool (*is_supported)();
    std::uint32_t (*sum)(Bytes bytes, std::uint32_t before);
};

std::span<const Crc32cKernel> crc32c_kernels();

}  // namespace bendy
