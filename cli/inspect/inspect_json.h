#pragma once

#include <bendy/format/chunk_reader.h>

#include <nlohmann/json.hpp>

#include <cstdint>

namespace bendy::cli {

/// The chunks from `root` on as a JSON array in file order; nesting is told by "parent", the number of an entry before
/// it, so that a skeleton of ten thousand levels is no deep JSON.
nlohmann::ordered_json chunks_as_json(const ChunkTree& tree, std::uint32_t root);

}  // namespace bendy::cli
