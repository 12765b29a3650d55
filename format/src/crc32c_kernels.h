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

/// Eight bytes at a time by tables; runs everywhere, and is the reference for the others.
std::uint32_t crc32c_tables(Bytes bytes, std::uint32_t before);

/// With the processor's own instruction (SSE 4.2, or ARMv8's CRC extension), three lanes in parallel. Only if it is
/// supported.
bool has_crc32c_instruction();
std::uint32_t crc32c_instruction(Bytes bytes, std::uint32_t before);

}  // namespace bendy
