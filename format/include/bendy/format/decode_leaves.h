#pragma once

#include <bendy/format/chunk_reader.h>
#include <bendy/format/public.h>

namespace BENDY_PUBLIC bendy {

/// Decodes every encoded leaf with a known id, so that ChunkTree::payload returns its content. Makes one allocation for
/// all of them, at most kMaxCodecRatio times the encoded bytes. A leaf that cannot be decoded becomes empty, and
/// ChunkTree::encoding_fault returns the reason.
void decode_leaves(ChunkTree& tree);

}  // namespace bendy
