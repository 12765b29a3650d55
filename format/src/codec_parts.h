#pragma once

#include <bendy/format/codec.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

// The codecs behind decode_payload and encode_payload: spec/codecs.md describes each bit by bit. `body` is the data
// after the CodecHeader; encoders append it to `out`. Decoders return false if it is damaged, encoders if they cannot
// encode the payload.
namespace bendy {

/// Codec 1, zstd_codecs.cpp: bytes, in byte planes if there is a stride.
bool decode_zstd(const CodecHeader& header, Bytes body, std::span<std::byte> out);
bool encode_zstd(const CodecHeader& header, Bytes payload, std::vector<std::byte>& out);

/// Codecs 2 to 5, mesh_codecs.cpp: meshoptimizer's vertex and index codecs (Kapoulkine,
/// https://github.com/zeux/meshoptimizer), the odd ones compressed with zstd.
bool decode_rows(const CodecHeader& header, bool is_zstd, Bytes body, std::span<std::byte> out);
bool encode_rows(const CodecHeader& header, bool is_zstd, Bytes payload, std::vector<std::byte>& out);
bool decode_triangles(const CodecHeader& header, bool is_zstd, Bytes body, std::span<std::byte> out);
/// Also returns false for a list that would not be reproduced exactly: canonical_triangles makes one that is.
bool encode_triangles(const CodecHeader& header, bool is_zstd, Bytes payload, std::vector<std::byte>& out);

/// Codec 6, clip_codec.cpp: a PACK payload, predicted, in byte planes, compressed with zstd. Decoding takes memory in
/// proportion to the encoded bytes, at most kMaxCodecRatio times them for each of a few arrays; encoding returns false
/// if write_packed could not have produced the payload.
bool decode_clip(Bytes body, std::span<std::byte> out);
bool encode_clip(Bytes payload, std::vector<std::byte>& out);

/// Codec 7, zstd_codecs.cpp. The first number of each row is replaced by the row's sum, which is the same for all
/// weights of a mesh.
bool decode_sums(const CodecHeader& header, Bytes body, std::span<std::byte> out);
bool encode_sums(const CodecHeader& header, Bytes payload, std::vector<std::byte>& out);

/// Appends the bytes as one zstd frame that states their size.
bool put_zstd(Bytes bytes, std::vector<std::byte>& out);
/// Decompresses; returns false unless the bytes are one zstd frame of exactly out.size() bytes.
bool take_zstd(Bytes bytes, std::span<std::byte> out);
/// Returns the size that the frame claims to have; it may be wrong.
std::optional<std::uint64_t> zstd_size(Bytes bytes);

/// Copies the payload's head, which is stored unchanged; returns false if the data is too short.
inline bool take_head(const CodecHeader& header, Bytes& body, std::span<std::byte>& out) {
    if (header.head > out.size() || header.head > body.size()) return false;
    std::copy_n(body.begin(), header.head, out.begin());
    body = body.subspan(header.head);
    out = out.subspan(header.head);
    return true;
}

/// Returns the number of rows or triangles; nothing if the size is not a multiple of the step.
inline std::optional<std::size_t> count_of(std::size_t size, std::size_t step) {
    if (step == 0 || size % step != 0) return std::nullopt;
    return size / step;
}

}  // namespace bendy
