#include "inspect/inspect_json.h"

#include "inspect/describe_chunk.h"

#include <array>
#include <cstdio>

namespace bendy::cli {

nlohmann::ordered_json chunks_as_json(const ChunkTree& tree, std::uint32_t root) {
    nlohmann::ordered_json chunks = nlohmann::ordered_json::array();
    for (std::uint32_t number = root; number < tree[root].end; ++number) {
        const Chunk& chunk = tree[number];
        std::array<char, 11> sum{};
        std::snprintf(sum.data(), sum.size(), "0x%08x", chunk.sum);
        nlohmann::ordered_json entry{
            {"number", number - root},
            {"parent", number == root ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(chunk.parent - root)},
            {"id", chunk.id.letters().data()},
            {"meaning", chunk_meaning(chunk.id)},
            {"offset", chunk.offset},
            {"size", chunk.size},
            {"sum", sum.data()},
            {"container", chunk.is_container()}};
        if (chunk.is_required()) entry["required"] = true;
        if (chunk.codec() != 0) {
            entry["codec"] = chunk.codec();
            entry["decoded"] = tree.payload(number).size();
        }
        if (auto fields = chunk_fields(tree, number); !fields.empty()) entry["fields"] = std::move(fields);
        chunks.push_back(std::move(entry));
    }
    return chunks;
}

}  // namespace bendy::cli
