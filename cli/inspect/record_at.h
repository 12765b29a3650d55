#pragma once

#include <bendy/format/chunk_reader.h>

#include <cstdint>

namespace bendy::cli {

/// What can be read of a record at the start of a leaf's payload; the rest, and all of it where there is no such leaf,
/// keeps its defaults. For showing files, good or bad.
template <class R>
R record_at(const ChunkTree& tree, std::uint32_t number) {
    R record;
    if (number != kNone && !tree[number].is_container()) copy_at(tree.payload(number), 0, record);
    return record;
}

}  // namespace bendy::cli
