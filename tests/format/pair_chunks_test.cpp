#include <bendy/format/pair_chunks.h>

#include "format/sample_file.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace bendy::pair_chunks_test {
namespace {

using Named = std::vector<std::pair<std::string, std::string>>;

/// A file with one joint for each (name, payload of an EXTR), in HEAD; the name may be empty.
test::Buffer file_of(const Named& joints) {
    ChunkWriter out;
    out.begin(FourCC("HEAD"));
    for (const auto& [name, extras] : joints) {
        out.begin(FourCC("SKIN"));
        if (!name.empty()) out.text_leaf(FourCC("NAME"), name);
        out.text_leaf(FourCC("EXTR"), extras);
        out.end();
    }
    out.end();
    return std::move(out).finish();
}

/// "0-1 1-x x-0": the places among the children, x for none.
std::string pairs_of(const test::Buffer& a, const test::Buffer& b) {
    const ChunkTree tree_a = *read_chunk_tree(a);
    const ChunkTree tree_b = *read_chunk_tree(b);
    const auto place = [](const ChunkTree& tree, std::uint32_t number) {
        if (number == kNone) return std::string("x");
        int at = 0;
        for (const std::uint32_t child : tree.children(0)) {
            if (child == number) return std::to_string(at);
            ++at;
        }
        return std::string("?");
    };
    std::string text;
    for (const ChunkPair& pair : pair_children(tree_a, 0, tree_b, 0))
        text += (text.empty() ? "" : " ") + place(tree_a, pair.a) + '-' + place(tree_b, pair.b);
    return text;
}

TEST(PairChunks, NamesGoBeforePlaces) {
    EXPECT_EQ(pairs_of(file_of({{"a", "1"}, {"b", "2"}}), file_of({{"new", "1"}, {"a", "3"}, {"b", "4"}})),
              "0-1 1-2 x-0");
    EXPECT_EQ(pairs_of(file_of({{"a", "1"}, {"b", "2"}}), file_of({{"b", "1"}, {"a", "2"}})), "0-1 1-0");
}

TEST(PairChunks, DoubledAndMissingNamesArePairedByContentThenPlace) {
    EXPECT_EQ(pairs_of(file_of({{"a", "1"}, {"a", "2"}}), file_of({{"a", "2"}, {"a", "3"}})), "0-1 1-0");
    EXPECT_EQ(
        pairs_of(file_of({{"", "1"}, {"", "2"}, {"", "3"}}), file_of({{"", "0"}, {"", "1"}, {"", "2"}, {"", "3"}})),
        "0-1 1-2 2-3 x-0");
    EXPECT_EQ(pairs_of(file_of({{"", "1"}, {"", "2"}}), file_of({{"", "3"}})), "0-0 1-x");
}

TEST(PairChunks, ARenamedChunkKeepsItsPlace) {
    EXPECT_EQ(pairs_of(file_of({{"a", "1"}, {"b", "2"}}), file_of({{"a", "1"}, {"c", "2"}})), "0-0 1-1");
}

TEST(PairChunks, IdsNeverMix) {
    const auto leaf = [](FourCC id) {
        ChunkWriter out;
        out.begin(FourCC("HEAD"));
        out.text_leaf(id, "x");
        out.end();
        return std::move(out).finish();
    };
    EXPECT_EQ(pairs_of(leaf(FourCC("AAAA")), leaf(FourCC("BBBB"))), "0-x x-0");
    EXPECT_EQ(pairs_of(leaf(FourCC("AAAA")), leaf(FourCC("AAAA"))), "0-0");
}

TEST(PairChunks, StreamsArePairedBySet) {
    const auto file = [](std::vector<std::uint32_t> sets, float number) {
        ChunkWriter out;
        out.begin(FourCC("HEAD"));
        for (const std::uint32_t set : sets)
            out.leaf(FourCC("TEXC"), test::stream_payload<float>(2, {number, number}, false, set));
        out.end();
        return std::move(out).finish();
    };
    EXPECT_EQ(pairs_of(file({0, 1, 2}, 0.0f), file({2, 0}, 1.0f)), "0-1 1-x 2-0");
}

TEST(PairChunks, EqualSumsMeanTheSameChunk) {
    const test::Buffer a = file_of({{"a", "1"}});
    const test::Buffer b = file_of({{"a", "2"}});
    const ChunkTree tree_a = *read_chunk_tree(a);
    const ChunkTree tree_b = *read_chunk_tree(b);
    EXPECT_TRUE(have_equal_sums(tree_a, 0, tree_a, 0));
    EXPECT_FALSE(have_equal_sums(tree_a, 0, tree_b, 0));
    EXPECT_TRUE(have_equal_sums(tree_a, 2, tree_b, 2));   // NAME
    EXPECT_FALSE(have_equal_sums(tree_a, 3, tree_b, 3));  // EXTR
}

}  // namespace
}  // namespace bendy::pair_chunks_test
