#pragma once

#include <bendy/format/codec.h>

#include <vector>

// Codecs 2 to 5: meshoptimizer's vertex and index codecs (Kapoulkine, https://github.com/zeux/meshoptimizer), the
// odd ones under zstd. `body` is what follows the CodecHeader.
namespace bendy {

bool decode_rows(const CodecHeader& header, bool is_zstd, Bytes body, std::span<std::byte> out);
bool encode_rows(const CodecHeader& header, bool is_zstd, Bytes payload, std::vector<std::byte>& out);

bool decode_triangles(const CodecHeader& header, bool is_zstd, Bytes body, std::span<std::byte> out);
/// False, too, for a list that would not come back to the bit: canonical_triangles makes one that does.
bool encode_triangles(const CodecHeader& header, bool is_zstd, Bytes payload, std::vector<std::byte>& out);

}  // namespace bendy
