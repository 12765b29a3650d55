#include <bendy/format/chunk_reader.h>

#include <bendy/format/crc32c.h>

#include "edit_file.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace bendy::check_sums_test {
namespace {

using namespace test;

/// The sum as the specification states it: over bytes gathered in one place.
std::uint32_t sum_by_the_book(const ChunkTree& tree, std::uint32_t number) {
    const Chunk& chunk = tree[number];
    const Bytes file = tree.bytes();
    Buffer covered;
    const auto cover = [&](Bytes bytes) { covered.insert(covered.end(), bytes.begin(), bytes.end()); };
    cover(file.subspan(chunk.offset, 4));
    cover(file.subspan(chunk.offset + 8, 8));
    if (chunk.is_container()) {
        for (const std::uint32_t child : tree.children(number)) cover(file.subspan(tree[child].offset + 4, 4));
    } else {
        cover(tree.payload(number));
    }
    return crc32c(covered);
}

Lines sum_faults(const Buffer& file) {
    const auto tree = read_chunk_tree(file);
    if (!tree) return {"malformed"};
    Faults faults;
    check_sums(*tree, faults);
    return lines_of(faults, file);
}

TEST(CheckSums, HoldsForWhatTheWriterWrites) {
    const Buffer file = sample_file();
    const auto tree = read_chunk_tree(file);
    ASSERT_TRUE(tree.has_value());
    for (std::uint32_t number = 0; number < tree->chunks().size(); ++number) {
        EXPECT_EQ((*tree)[number].sum, sum_by_the_book(*tree, number)) << number;
        EXPECT_EQ(chunk_sum(Bytes(file).subspan((*tree)[number].offset)), sum_by_the_book(*tree, number)) << number;
    }
    EXPECT_EQ(sum_faults(file), Lines{});
}

TEST(CheckSums, OfAnEmptyContainerCoversItsHeader) {
    const Buffer file = to_file(make_container(FourCC("HEAD")));
    std::uint32_t sum = 0;
    copy_at(file, 4, sum);
    EXPECT_EQ(sum, crc32c(as_byte_span(std::string_view("HEAD\0\0\0\0\0\0\1\0", 12))));
}

TEST(CheckSums, BlamesTheLeafThatIsDamagedAndNoOther) {
    Buffer file = sample_file();
    patch(file, place_of(file, "HEAD/OBJE/VECT/NORM") + 40, std::byte{0x55});
    EXPECT_EQ(sum_faults(file), Lines{"SUM_MISMATCH HEAD/OBJE/VECT/NORM"});
}

TEST(CheckSums, BlamesALeafWithAWrongSumAndItsContainer) {
    Buffer file = sample_file();
    patch(file, place_of(file, "HEAD/OBJE/VECT/NORM") + 4, 0xdeadbeefu);
    EXPECT_EQ(sum_faults(file), (Lines{"SUM_MISMATCH HEAD/OBJE/VECT", "SUM_MISMATCH HEAD/OBJE/VECT/NORM"}));
}

TEST(CheckSums, NoticesSiblingsThatChangePlaces) {
    const Buffer file = to_file(make_container(FourCC("HEAD"), {make_leaf(FourCC("AAAA")), make_leaf(FourCC("BBBB"))}));
    Buffer swapped(file.begin(), file.begin() + 16);
    swapped.insert(swapped.end(), file.begin() + 32, file.begin() + 48);
    swapped.insert(swapped.end(), file.begin() + 16, file.begin() + 32);
    EXPECT_EQ(sum_faults(swapped), Lines{"SUM_MISMATCH HEAD"});
}

TEST(CheckSums, StatesTheSumThatShouldStandThere) {
    Buffer file = sample_file();
    const std::uint64_t offset = place_of(file, "HEAD/VERS");
    std::uint32_t good = 0;
    copy_at(file, offset + 4, good);
    patch(file, offset + 4, good ^ 1u);
    const Faults faults = validate(file);
    ASSERT_EQ(faults.list().size(), 2u);
    EXPECT_EQ(faults.list()[1].value, good);
    EXPECT_EQ(faults.list()[1].limit, good ^ 1u);
}

}  // namespace
}  // namespace bendy::check_sums_test
