#pragma once

#include <bendy/format/byte_reader.h>

#include <cstdint>
#include <string>
#include <vector>

namespace bendy::converter {

/// Bytes of a file by what they are for, headers and padding included.
struct ByteCount {
    std::string kind;  ///< skeleton, POSI, ..., indices, targets, cycles, textures, other
    std::uint64_t bytes = 0;
};

/// Every kind, in the order in which they are shown; the bytes must be a well-formed file.
std::vector<ByteCount> count_bytes(Bytes file);

/// What compact encodings have done to a character.
struct CompactReport {
    double max_error = 0.0;       ///< metres: what was asked for
    double height = 0.0;          ///< metres, at rest
    double measured_error = 0.0;  ///< metres: the worst that was met
    std::string place;            ///< where: mesh, vertex, pose; empty if nothing moved
    std::vector<ByteCount> exact, compact;
};

}  // namespace bendy::converter
