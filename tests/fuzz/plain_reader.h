#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

// The grammar of spec/grammar.md a second time, as short as it can be: what the real reader is held against.
namespace bendy::fuzz {

struct PlainChunk {
    std::string id;
    std::uint64_t offset = 0;
    std::uint64_t size = 0;
    unsigned flags = 0;
    std::size_t depth = 0;
    bool sum_holds = false;
};

struct PlainFile {
    bool is_well_formed = false;
    std::vector<PlainChunk> chunks;  ///< in the order in which they stand
};

/// Reads by recursion: for small files.
PlainFile read_plainly(std::span<const std::byte> file);

}  // namespace bendy::fuzz
