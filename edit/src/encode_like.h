#pragma once

#include "rewrite.h"

namespace bendy::edit {

/// Returns a whole leaf with the id and flags of an existing one, and a new payload: with the same codec if that makes
/// it smaller and is exactly reversible, otherwise with zstd, otherwise raw.
Buffer encode_like(const ChunkTree& tree, std::uint32_t number, Bytes payload);
/// The same for a leaf with another id, with this codec.
Buffer encode_leaf(FourCC id, std::uint16_t flags, Codec codec, std::uint16_t head, std::uint16_t stride,
                   Bytes payload);

}  // namespace bendy::edit
