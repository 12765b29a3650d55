#pragma once

#include <bendy/format/chunk_reader.h>
#include <bendy/format/faults.h>
#include <bendy/format/public.h>

#include <cstdint>

// Sums nest. A leaf's sum is the CRC-32C of its id, its size+flags and its payload; a container's, of its id, its
// size+flags and its children's stored sums in order. So the root's sum vouches for the whole file and any subtree can
// be checked by itself. Sums find accidents, never attackers.
namespace BENDY_PUBLIC bendy {

/// The sum that a chunk should carry; `chunk` starts at its header, and its sizes have been checked (read_chunk_tree)
/// or just been written.
std::uint32_t chunk_sum(Bytes chunk);

/// Adds a SUM_MISMATCH for every chunk of the tree whose stored sum is not the one it should carry.
void check_sums(const ChunkTree& tree, Faults& faults);

}  // namespace bendy
