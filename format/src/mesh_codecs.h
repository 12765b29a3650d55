#pragma once

#include <bendy/format/codec.h>

#include <vector>

// Codecs 2 to 5: meshoptimizer's vertex and index codecs (Kapoulkine, https://github.com/zeux/meshoptimizer), the odd
// ones compressed with zstd. `body` is the data after the CodecHeader.
namespace bendy {

bool decode_rows(const CodecHeader& header, bool is_zstd, Bytes body, std::span<std::byte> out);
bool encode_rows(const CodecHeader& header, bool is_zstd, Bytes payload, std::vector<std::byte>& out);

bool decode_triangles(const CodecHeader& header, bool is_zstd, Bytes body, std::span<std::byte> out);
/// Also returns false for a list that would not be reproduced exactly: canonical_triangles makes one that is.
bool encode_triangles(const CodecHeader& header, bool is_zstd, Bytes payload, std::vector<std::byte>& out);

}  // namespace bendy
