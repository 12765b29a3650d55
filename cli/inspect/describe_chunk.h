#pragma once

#include "inspect/describe_rig.h"

#include <bendy/format/chunk_reader.h>

#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>
#include <string_view>

namespace bendy::cli {

/// What is in a chunk, in a few words for the tree: a name, counts, the values that matter. Works on any tree, whatever
/// its records hold. \param rigs made of the same tree
std::string describe_chunk(const ChunkTree& tree, std::uint32_t number, const RigIndex& rigs);

/// How a chunk with a codec is encoded: "encoded: zstd, 1,024 bytes decoded".
std::string encoding_text(const ChunkTree& tree, std::uint32_t number);

/// The fields of a chunk's record by name, as records.def has them; text chunks give {"text": ...}. Empty for chunks
/// without a record.
nlohmann::ordered_json chunk_fields(const ChunkTree& tree, std::uint32_t number);

/// The chunks from `root` on as a JSON array in file order; nesting is told by "parent", the number of an entry before
/// it, so that a skeleton of ten thousand levels is no deep JSON.
nlohmann::ordered_json chunks_as_json(const ChunkTree& tree, std::uint32_t root);

/// What the id stands for ("joint", "key times", ...), or "unknown".
std::string_view chunk_meaning(FourCC id);

}  // namespace bendy::cli
