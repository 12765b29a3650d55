#pragma once

#include <bendy/format/chunk_reader.h>
#include <bendy/format/public.h>

#include <cstdint>
#include <vector>

namespace BENDY_PUBLIC bendy {

/// A chunk of one tree and the corresponding chunk of another; kNone: there is none.
struct ChunkPair {
    std::uint32_t a = kNone;
    std::uint32_t b = kNone;
};

/// Returns true if two subtrees contain the same bytes, judging by their sums.
bool have_equal_sums(const ChunkTree& a, std::uint32_t a_chunk, const ChunkTree& b, std::uint32_t b_chunk);

/// Pairs the children of two containers. Only chunks with the same id are paired: first those whose key is unique among
/// their siblings of that id on both sides (a container's NAME, the set of TEXC and COLR, the scope of LIMT, the chain
/// of PULL), so that one additional chunk does not shift all that follow; then, in order, those with equal sums; then
/// the rest, in order. The result lists A's children in A's order, then those that only B has in B's order.
std::vector<ChunkPair> pair_children(const ChunkTree& a, std::uint32_t a_container, const ChunkTree& b,
                                     std::uint32_t b_container);

}  // namespace bendy
