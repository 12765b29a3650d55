// Our reader beside a plain second one: they accept the same files, and find the same chunks and sums in them.
#include "check.h"
#include "plain_reader.h"

#include <bendy/format/chunk_reader.h>

#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace bendy;
    const auto* bytes = reinterpret_cast<const std::byte*>(data);
    const std::vector<std::byte> file(bytes, bytes + size);
    const fuzz::PlainFile plain = fuzz::read_plainly(file);
    const auto tree = read_chunk_tree(file);
    fuzz::check(tree.has_value() == plain.is_well_formed, "both readers accept the same files");
    if (!tree) return 0;

    Faults faults;
    check_sums(*tree, faults);
    std::set<std::uint64_t> wrong_sums;
    for (const Error& fault : faults.list()) wrong_sums.insert(fault.offset);

    fuzz::check(tree->chunks().size() == plain.chunks.size(), "both find as many chunks");
    std::vector<std::size_t> depths;
    for (std::size_t number = 0; number < plain.chunks.size(); ++number) {
        const Chunk& ours = tree->chunks()[number];
        const fuzz::PlainChunk& theirs = plain.chunks[number];
        depths.push_back(number == 0 ? 0 : depths[ours.parent] + 1);
        fuzz::check(ours.id.letters().data() == theirs.id, "both read the same id");
        fuzz::check(ours.offset == theirs.offset && ours.size == theirs.size, "both find it in the same place");
        fuzz::check(ours.flags == theirs.flags, "both read the same flags");
        fuzz::check(depths.back() == theirs.depth, "both find it as deep");
        if (faults.left_out() == 0)
            fuzz::check((wrong_sums.count(ours.offset) == 0) == theirs.sum_holds, "both reckon the same sum");
    }
    return 0;
}
