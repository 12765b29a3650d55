#pragma once

#include <bendy/format/chunk_reader.h>
#include <bendy/format/faults.h>
#include <bendy/format/public.h>

#include <cstdint>

// Sums nest. The sum of a leaf is the CRC-32C of its id, its size+flags and its payload; that of a container, of its
// id, its size+flags and its children's stored sums in order. So the root's sum covers the whole file, and any subtree
// can be checked by itself. Sums detect accidental damage, not attacks.
namespace BENDY_PUBLIC bendy {

/// Computes the sum that a chunk should have. `chunk` starts at its header, and its sizes have been checked
/// (read_chunk_tree) or have just been written.
std::uint32_t chunk_sum(Bytes chunk);

/// Adds a SUM_MISMATCH for every chunk of the tree whose stored sum is wrong.
void check_sums(const ChunkTree& tree, Faults& faults);

}  // namespace bendy
