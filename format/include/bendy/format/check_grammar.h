#pragma once

#include <bendy/format/chunk_reader.h>
#include <bendy/format/faults.h>
#include <bendy/format/public.h>

namespace BENDY_PUBLIC bendy {

/// Checks every chunk against the table chunk_ids.def: that a known chunk is in an allowed container, is a leaf or
/// container as required, and occurs as often as allowed. An unknown chunk is skipped with its contents, unless it is
/// marked as required.
void check_grammar(const ChunkTree& tree, Faults& faults);

/// Returns true if this version knows the id.
bool is_known(FourCC id);

}  // namespace bendy
