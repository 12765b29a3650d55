#pragma once

#include <bendy/format/chunk_reader.h>
#include <bendy/format/faults.h>
#include <bendy/format/public.h>

namespace BENDY_PUBLIC bendy {

/// Holds every chunk against the table chunk_ids.def: a known one stands where it may, is leaf or container as it must
/// be, as often as it may; an unknown one is skipped with all inside it, unless it is marked required.
void check_grammar(const ChunkTree& tree, Faults& faults);

/// Whether this version has a page for the id.
bool is_known(FourCC id);

}  // namespace bendy
