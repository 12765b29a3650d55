#pragma once

#include <bendy/format/chunk_reader.h>
#include <bendy/format/public.h>

namespace BENDY_PUBLIC bendy {

/// Decodes every encoded leaf whose id is known, so that ChunkTree::payload gives what it means. One allocation for all
/// of them, at most kMaxCodecRatio times the encoded bytes. A leaf that cannot be decoded is empty from here on, and
/// ChunkTree::encoding_fault says why to those who read it.
void decode_leaves(ChunkTree& tree);

}  // namespace bendy
