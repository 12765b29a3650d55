#pragma once

#include <bendy/format/byte_reader.h>

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

// Codec::clip: a PACK payload, predicted, in byte planes, compressed with zstd. spec/codecs.md describes it bit by bit.
namespace bendy {

/// Appends the data after the CodecHeader; returns false if write_packed could not have produced the payload.
bool encode_clip(Bytes payload, std::vector<std::byte>& out);

/// Decodes the payload of out.size() bytes from the data after the CodecHeader; returns false if it is damaged. Takes
/// memory in proportion to the encoded bytes, at most kMaxCodecRatio times them for each of a few arrays.
bool decode_clip(Bytes body, std::span<std::byte> out);

}  // namespace bendy
