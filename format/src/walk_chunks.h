#pragma once

#include <bendy/format/chunk_reader.h>

#include <cstdint>

namespace bendy {

/// read_chunk_tree with a custom limit, so that a test needs no file of 32 GiB.
/// \param most_chunks  from 1 to kMaxChunks
Result<ChunkTree> walk_chunks(Bytes bytes, std::uint64_t most_chunks);

}  // namespace bendy
