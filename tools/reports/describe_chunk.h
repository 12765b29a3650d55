#pragma once

#include "reports/describe_rig.h"

#include <bendy/format/chunk_reader.h>
#include <bendy/format/error.h>
#include <bendy/json/json.h>

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace bendy::tools {

/// Describes the content of a chunk for the tree in a few words: a name, counts, the important values. Works on any
/// tree, whatever its records hold. \param rigs  made from the same tree
std::string describe_chunk(const ChunkTree& tree, std::uint32_t number, const RigIndex& rigs);

/// Describes how a chunk with a codec is encoded: "encoded: zstd, 1,024 bytes decoded".
std::string encoding_text(const ChunkTree& tree, std::uint32_t number);

/// Returns the fields of a chunk's record by their names in records.def; for text chunks {"text": ...}. Empty for
/// chunks without a record.
OrderedJson chunk_fields(const ChunkTree& tree, std::uint32_t number);

/// The chunks that have faults, for the tree.
class FaultyChunks {
public:
    FaultyChunks(const ChunkTree& tree, const Faults& faults);

    /// Returns what is wrong with a chunk, its first fault; empty if nothing is.
    [[nodiscard]] std::string text(std::uint32_t number) const;
    /// True if a chunk, or one in it, has a fault.
    [[nodiscard]] bool has_fault(const ChunkTree& tree, std::uint32_t number) const;

private:
    std::map<std::uint32_t, Error> first_;  // of each chunk
};

/// Returns the number of the innermost chunk at an offset; kNone if there is none.
std::uint32_t chunk_at(const ChunkTree& tree, std::uint64_t offset);

/// Returns the chunks from `root` on as a JSON array in file order. An entry's "parent" is the number of an earlier
/// entry, so that a skeleton of ten thousand levels does not nest the JSON.
OrderedJson chunks_as_json(const ChunkTree& tree, std::uint32_t root, const FaultyChunks& faulty);

/// Returns the meaning of an id ("joint", "key times", ...), or "unknown".
std::string_view chunk_meaning(FourCC id);

}  // namespace bendy::tools
