#pragma once

#include <bendy/format/byte_reader.h>

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

// Codec::clip: a PACK payload, predicted, in byte planes, under zstd. spec/codecs.md has it to the bit.
namespace bendy {

/// Appends what follows the CodecHeader; false if the payload is not one that write_packed makes.
bool encode_clip(Bytes payload, std::vector<std::byte>& out);

/// The payload of out.size() bytes from what follows the CodecHeader; false if it is damaged. Takes memory in
/// proportion to the encoded bytes, at most kMaxCodecRatio times them for each of a few arrays.
bool decode_clip(Bytes body, std::span<std::byte> out);

}  // namespace bendy
