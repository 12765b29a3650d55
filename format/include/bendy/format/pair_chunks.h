#pragma once

#include <bendy/format/chunk_reader.h>
#include <bendy/format/public.h>

#include <cstdint>
#include <vector>

namespace BENDY_PUBLIC bendy {

/// A chunk of one tree and the one of another tree that stands for the same thing; kNone: there is none.
struct ChunkPair {
    std::uint32_t a = kNone;
    std::uint32_t b = kNone;
};

/// True when two subtrees hold the same bytes, as far as their sums tell.
bool have_equal_sums(const ChunkTree& a, std::uint32_t a_chunk, const ChunkTree& b, std::uint32_t b_chunk);

/// Pairs the children of two containers. Only chunks of one id make a pair: first those whose key is unique among their
/// siblings of that id on both sides (a container's NAME, the set of TEXC and COLR, the scope of LIMT, the chain of
/// PULL), so that one chunk more does not shift all that follow; then, in their order, those with equal sums; then
/// what is left, in its order. A's children come first, in its order, then those that only B has, in its order.
std::vector<ChunkPair> pair_children(const ChunkTree& a, std::uint32_t a_container, const ChunkTree& b,
                                     std::uint32_t b_container);

}  // namespace bendy
