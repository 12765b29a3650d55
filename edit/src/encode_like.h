#pragma once

#include "rewrite.h"

namespace bendy::edit {

/// A whole leaf with the id and flags of one that is there, and another payload: under the same codec where that makes
/// it smaller and gives it back to the bit, else under zstd, else raw.
Buffer encode_like(const ChunkTree& tree, std::uint32_t number, Bytes payload);
/// The same for a leaf of another id, under this codec.
Buffer encode_leaf(FourCC id, std::uint16_t flags, Codec codec, std::uint16_t head, std::uint16_t stride,
                   Bytes payload);

}  // namespace bendy::edit
