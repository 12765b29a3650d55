#pragma once

#include "reports/describe_rig.h"

#include <bendy/format/chunk_reader.h>

#include <nlohmann/json.hpp>

#include <cstdint>
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
nlohmann::ordered_json chunk_fields(const ChunkTree& tree, std::uint32_t number);

/// Returns the chunks from `root` on as a JSON array in file order. An entry's "parent" is the number of an earlier
/// entry, so that a skeleton of ten thousand levels does not nest the JSON.
nlohmann::ordered_json chunks_as_json(const ChunkTree& tree, std::uint32_t root);

/// Returns the meaning of an id ("joint", "key times", ...), or "unknown".
std::string_view chunk_meaning(FourCC id);

}  // namespace bendy::tools
