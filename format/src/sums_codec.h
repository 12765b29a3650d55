#pragma once

#include <bendy/format/codec.h>

#include <vector>

namespace bendy {

/// Codec 7. The first number of each row is replaced by the row's sum, which is the same for all weights of a mesh.
bool decode_sums(const CodecHeader& header, Bytes body, std::span<std::byte> out);
bool encode_sums(const CodecHeader& header, Bytes payload, std::vector<std::byte>& out);

}  // namespace bendy
