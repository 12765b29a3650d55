#include "optimise/passes/equal_vertices.h"

#include <algorithm>
#include <cstring>

namespace bendy::converter {
namespace {

struct Hashed {
    std::uint64_t hash = 0;
    std::uint32_t vertex = 0;
};

std::uint64_t mixed(std::uint64_t hash, std::uint64_t word) {
    constexpr std::uint64_t kOdd = 0x9e3779b97f4a7c15;
    hash = (hash ^ word) * kOdd;
    return hash ^ (hash >> 32U);
}

Bytes row_of(const VertexRows& stream, std::uint32_t vertex) {
    return stream.bytes.subspan(vertex * stream.width, stream.width);
}

std::uint64_t hash_of(std::uint32_t vertex, std::span<const VertexRows> streams) {
    std::uint64_t hash = 0;
    for (const VertexRows& stream : streams) {
        Bytes row = row_of(stream, vertex);
        while (!row.empty()) {
            std::uint64_t word = 0;
            const std::size_t size = std::min(row.size(), sizeof word);
            std::memcpy(&word, row.data(), size);
            hash = mixed(hash, word);
            row = row.subspan(size);
        }
    }
    return hash;
}

}  // namespace

std::vector<std::uint32_t> first_equal_vertices(std::size_t vertices, std::span<const VertexRows> streams) {
    // Equal vertices have equal hashes. What decides is the order of their bytes, so that no choice of bytes takes
    // long.
    std::vector<Hashed> order(vertices);
    for (std::uint32_t vertex = 0; vertex < vertices; ++vertex) order[vertex] = {hash_of(vertex, streams), vertex};
    const auto compare = [&](const Hashed& a, const Hashed& b) {
        if (a.hash != b.hash) return a.hash < b.hash ? -1 : 1;
        for (const VertexRows& stream : streams) {
            const Bytes row = row_of(stream, a.vertex);
            const int sign = std::memcmp(row.data(), row_of(stream, b.vertex).data(), row.size());
            if (sign != 0) return sign;
        }
        return 0;
    };
    std::sort(order.begin(), order.end(), [&](const Hashed& a, const Hashed& b) {
        const int sign = compare(a, b);
        return sign != 0 ? sign < 0 : a.vertex < b.vertex;
    });
    std::vector<std::uint32_t> first_of(vertices);
    for (std::size_t k = 0; k < vertices; ++k) {
        const bool is_alike = k != 0 && compare(order[k - 1], order[k]) == 0;
        first_of[order[k].vertex] = is_alike ? first_of[order[k - 1].vertex] : order[k].vertex;
    }
    return first_of;
}

}  // namespace bendy::converter
