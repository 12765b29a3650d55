#include "encode_like.h"

#include <algorithm>
#include <optional>

namespace bendy::edit {
namespace {

std::optional<Buffer> encoded(Codec codec, Bytes payload, std::uint16_t head, std::uint16_t stride) {
    if (payload.size() <= head) return std::nullopt;
    auto bytes = encode_payload(codec, payload, head, stride);
    if (!bytes || bytes->size() >= payload.size()) return std::nullopt;
    AlignedBytes decoded(payload.size());
    const bool is_lossless = decode_payload(codec, *bytes, decoded.span()) &&
                             std::equal(payload.begin(), payload.end(), decoded.bytes().begin());
    return is_lossless ? bytes : std::nullopt;
}

}  // namespace

Buffer encode_leaf(FourCC id, std::uint16_t flags, Codec codec, std::uint16_t head, std::uint16_t stride,
                   Bytes payload) {
    const auto plain = static_cast<std::uint16_t>(flags & ~kCodecMask);
    const auto with = [&](Codec used, const Buffer& bytes) {
        return whole_leaf(id, bytes, static_cast<std::uint16_t>(plain | static_cast<unsigned>(used) << 8));
    };
    if (codec == Codec::raw) return whole_leaf(id, payload, plain);
    if (const auto bytes = encoded(codec, payload, head, stride)) return with(codec, *bytes);
    if (const auto bytes = encoded(Codec::zstd, payload, 0, 0)) return with(Codec::zstd, *bytes);
    return whole_leaf(id, payload, plain);
}

Buffer encode_like(const ChunkTree& tree, std::uint32_t number, Bytes payload) {
    const Chunk& chunk = tree[number];
    CodecHeader header;
    if (chunk.codec() != 0) copy_at(tree.stored(number), 0, header);
    return encode_leaf(chunk.id, chunk.flags, static_cast<Codec>(chunk.codec()), header.head, header.stride, payload);
}

}  // namespace bendy::edit
