#include <bendy/format/chunk_writer.h>

#include "edit_file.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string_view>

namespace bendy::chunk_writer_test {
namespace {

using namespace test;

template <class T>
T number_at(Bytes file, std::uint64_t offset) {
    T value{};
    copy_at(file, offset, value);
    return value;
}

TEST(ChunkWriter, LaysOutHeaderPayloadAndPadding) {
    ChunkWriter writer;
    writer.begin(FourCC("HEAD"));
    writer.leaf(FourCC("ABCD"), as_byte_span("hello"), kRequiredFlag);
    writer.end();
    const Buffer file = std::move(writer).finish();
    ASSERT_EQ(file.size(), 48u);
    EXPECT_EQ(as_text(Bytes(file).first(4)), "HEAD");
    EXPECT_EQ(number_at<std::uint64_t>(file, 8), 0x0001'0000'0000'0020u);
    EXPECT_EQ(as_text(Bytes(file).subspan(16, 4)), "ABCD");
    EXPECT_EQ(number_at<std::uint64_t>(file, 24), 0x0002'0000'0000'0005u);
    EXPECT_EQ(as_text(Bytes(file).subspan(32, 16)), std::string_view("hello\0\0\0\0\0\0\0\0\0\0\0", 16));
}

TEST(ChunkWriter, PadsEveryLengthToTheNextBoundary) {
    for (std::size_t size = 0; size <= 33; ++size) {
        const Buffer payload(size, std::byte{0xee});
        ChunkWriter writer;
        writer.begin(FourCC("HEAD"));
        writer.leaf(FourCC("AAAA"), payload);
        writer.leaf(FourCC("BBBB"), payload);
        writer.end();
        const Buffer file = std::move(writer).finish();
        EXPECT_EQ(file.size(), 16 + 2 * (16 + (size + 15) / 16 * 16)) << size;
        const auto tree = read_chunk_tree(file);
        ASSERT_TRUE(tree.has_value()) << size;
        for (const std::uint32_t number : {1u, 2u}) {
            const Bytes read = tree->payload(number);
            EXPECT_TRUE(std::equal(read.begin(), read.end(), payload.begin(), payload.end())) << size;
        }
    }
}

TEST(ChunkWriter, JoinsThePiecesOfALeaf) {
    const auto write = [](auto put_leaf) {
        ChunkWriter writer;
        writer.begin(FourCC("HEAD"));
        put_leaf(writer);
        writer.end();
        return std::move(writer).finish();
    };
    const Buffer whole = write([](ChunkWriter& w) { w.leaf(FourCC("AAAA"), as_byte_span("one two")); });
    const Buffer pieces = write([](ChunkWriter& w) {
        w.leaf(FourCC("AAAA"), std::array{as_byte_span("one"), Bytes(), as_byte_span(" "), as_byte_span("two")});
    });
    const Buffer text = write([](ChunkWriter& w) { w.text_leaf(FourCC("AAAA"), "one two"); });
    EXPECT_EQ(whole, pieces);
    EXPECT_EQ(whole, text);
}

TEST(ChunkWriter, NeedsNoPiecesForAnEmptyLeaf) {
    ChunkWriter writer;
    writer.begin(FourCC("HEAD"));
    writer.leaf(FourCC("AAAA"), std::span<const Bytes>{});
    writer.end();
    EXPECT_EQ(std::move(writer).finish(), to_file(make_container(FourCC("HEAD"), {make_leaf(FourCC("AAAA"))})));
}

TEST(ChunkWriter, CopiesAChunkOfAnotherFileByteForByte) {
    const Buffer other = sample_file();
    const auto tree = read_chunk_tree(other);
    ASSERT_TRUE(tree.has_value());
    const Chunk& object = (*tree)[find_path(*tree, "HEAD/OBJE")];
    const Bytes whole = Bytes(other).subspan(object.offset, kChunkHeaderSize + object.size);
    ChunkWriter writer;
    writer.begin(FourCC("HEAD"));
    writer.text_leaf(FourCC("AAAA"), "before");
    writer.copy(whole);
    writer.text_leaf(FourCC("BBBB"), "after");
    writer.end();
    const Buffer file = std::move(writer).finish();
    const std::uint64_t copied = place_of(file, "HEAD/OBJE");
    const Bytes there = Bytes(file).subspan(copied, whole.size());
    EXPECT_TRUE(std::equal(whole.begin(), whole.end(), there.begin()));
    Faults faults;
    check_sums(*read_chunk_tree(file), faults);
    EXPECT_TRUE(faults.empty());
}

TEST(ChunkWriter, WritesBackEveryChunkOfAFileAsItWas) {
    const Buffer file = sample_file();
    EXPECT_EQ(to_file(to_node(file)), file);
}

TEST(ChunkWriter, GivesTheSameBytesEveryTime) {
    EXPECT_EQ(sample_file(), sample_file());
}

}  // namespace
}  // namespace bendy::chunk_writer_test
