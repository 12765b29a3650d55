#include "compact/encode_leaf.h"

#include <bendy/format/chunk.h>

#include <utility>

namespace bendy::converter {

EncodedLeaf encode_leaf(Bytes payload, const LeafShape& shape) {
    EncodedLeaf best;
    std::uint64_t smallest = padded(payload.size());  // a saving that padding eats is none
    const auto offer = [&](Codec codec, std::uint16_t head, std::uint16_t stride) {
        auto encoded = encode_payload(codec, payload, head, stride);
        if (!encoded || padded(encoded->size()) >= smallest) return;
        smallest = padded(encoded->size());
        best = {codec, std::move(*encoded)};
    };
    if (shape.is_packed_cycle) offer(Codec::cycle, 0, 0);
    if (shape.is_triangles) {
        offer(Codec::indices, shape.head, shape.number);
        offer(Codec::indices_zstd, shape.head, shape.number);
    }
    if (shape.row != 0) {
        offer(Codec::vertices, shape.head, shape.row);
        offer(Codec::vertices_zstd, shape.head, shape.row);
        offer(Codec::zstd, 0, shape.row);
        if (shape.sums) offer(Codec::sums, shape.head, shape.row);
    }
    if (shape.number > 1 && shape.number != shape.row) offer(Codec::zstd, 0, shape.number);
    offer(Codec::zstd, 0, 0);
    return best;
}

}  // namespace bendy::converter
