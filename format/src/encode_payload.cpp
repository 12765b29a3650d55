#include <bendy/format/codec.h>

#include "clip_codec.h"
#include "mesh_codecs.h"
#include "planes.h"
#include "sums_codec.h"
#include "zstd_frame.h"

#include <algorithm>
#include <span>

namespace bendy {
namespace {

bool encode_zstd(Bytes payload, std::uint16_t stride, std::vector<std::byte>& out) {
    if (stride <= 1) return put_zstd(payload, out);
    AlignedBytes planes(payload.size());
    to_planes(payload, stride, planes.span());
    return put_zstd(planes.bytes(), out);
}

}  // namespace

std::optional<std::vector<std::byte>> encode_payload(Codec codec, Bytes payload, std::uint16_t head,
                                                     std::uint16_t stride) {
    const CodecHeader header{payload.size(), head, stride, 0};
    std::vector<std::byte> out(sizeof header);
    std::copy_n(std::as_bytes(std::span(&header, 1)).begin(), sizeof header, out.begin());
    bool is_done = false;
    switch (codec) {
        case Codec::zstd:
            is_done = head == 0 && encode_zstd(payload, stride, out);
            break;
        case Codec::vertices:
        case Codec::vertices_zstd:
            is_done = encode_rows(header, codec == Codec::vertices_zstd, payload, out);
            break;
        case Codec::sums:
            is_done = encode_sums(header, payload, out);
            break;
        case Codec::indices:
        case Codec::indices_zstd:
            is_done = encode_triangles(header, codec == Codec::indices_zstd, payload, out);
            break;
        case Codec::clip:
            is_done = head == 0 && stride == 0 && encode_clip(payload, out);
            break;
        default:
            break;
    }
    if (!is_done || payload.size() > out.size() * kMaxCodecRatio) return std::nullopt;
    return out;
}

}  // namespace bendy
