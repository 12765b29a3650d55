#include <bendy/format/decode_leaves.h>

#include <bendy/format/check_grammar.h>
#include <bendy/format/codec.h>

namespace bendy {

void decode_leaves(ChunkTree& tree) {
    DecodedLeaves decoded;
    std::uint64_t size = 0;
    for (std::uint32_t number = 0; number < tree.chunks().size(); ++number) {
        const Chunk& chunk = tree[number];
        if (chunk.codec() == 0 || !is_known(chunk.id)) continue;
        DecodedLeaf leaf{number, size, 0, std::nullopt};
        CodecHeader header;
        leaf.fault = check_encoded(chunk.codec(), tree.stored(number), header);
        if (leaf.fault) {
            leaf.fault->offset = chunk.offset;
        } else {
            leaf.size = header.size;
            size += padded(header.size);
        }
        decoded.leaves.push_back(leaf);
    }
    if (decoded.leaves.empty()) return;
    decoded.bytes = AlignedBytes(size);
    for (DecodedLeaf& leaf : decoded.leaves) {
        if (leaf.fault) continue;
        const Chunk& chunk = tree[leaf.number];
        const auto out = decoded.bytes.span().subspan(leaf.at, leaf.size);
        if (decode_payload(static_cast<Codec>(chunk.codec()), tree.stored(leaf.number), out)) continue;
        leaf.fault = Error{ErrorCode::kCodecData, chunk.offset, chunk.codec()};
        leaf.size = 0;
    }
    tree.set_decoded(std::move(decoded));
}

}  // namespace bendy
