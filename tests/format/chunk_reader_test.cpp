#include <bendy/format/chunk_reader.h>

#include "edit_file.h"
#include "walk_chunks.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace bendy::chunk_reader_test {
namespace {

using namespace test;

/// HEAD with a leaf of 5 bytes, a container with an empty leaf and an empty container, and a leaf of 16 bytes.
Buffer small_file() {
    return to_file(make_container(
        FourCC("HEAD"), {make_leaf(FourCC("AAAA"), as_byte_span("hello")),
                         make_container(FourCC("BBBB"), {make_leaf(FourCC("CCCC")), make_container(FourCC("DDDD"))}),
                         make_leaf(FourCC("AAAA"), as_byte_span("0123456789abcdef"), kRequiredFlag)}));
}

/// The code that reading ends with, and where.
void expect_refused(Bytes file, ErrorCode code, std::uint64_t offset) {
    const auto tree = read_chunk_tree(file);
    ASSERT_FALSE(tree.has_value());
    EXPECT_STREQ(code_name(tree.error().code), code_name(code));
    EXPECT_EQ(tree.error().offset, offset);
}

TEST(ChunkReader, ListsChunksInFileOrderWithTheirPlaces) {
    const Buffer file = small_file();
    const auto tree = read_chunk_tree(file);
    ASSERT_TRUE(tree.has_value());
    struct Expected {
        const char* id;
        std::uint64_t offset, size;
        std::uint32_t parent, end;
    };
    const std::vector<Expected> expected{{"HEAD", 0, 112, 0, 6}, {"AAAA", 16, 5, 0, 2}, {"BBBB", 48, 32, 0, 5},
                                         {"CCCC", 64, 0, 2, 4},  {"DDDD", 80, 0, 2, 5}, {"AAAA", 96, 16, 0, 6}};
    ASSERT_EQ(tree->chunks().size(), expected.size());
    EXPECT_EQ(file.size(), 128u);
    for (std::uint32_t number = 0; number < expected.size(); ++number) {
        const Chunk& chunk = (*tree)[number];
        EXPECT_STREQ(chunk.id.letters().data(), expected[number].id) << number;
        EXPECT_EQ(chunk.offset, expected[number].offset) << number;
        EXPECT_EQ(chunk.size, expected[number].size) << number;
        EXPECT_EQ(chunk.parent, expected[number].parent) << number;
        EXPECT_EQ(chunk.end, expected[number].end) << number;
    }
    EXPECT_TRUE((*tree)[5].is_required());
    EXPECT_FALSE((*tree)[1].is_required());
}

TEST(ChunkReader, GivesPayloadsInPlaceAndWithoutPadding) {
    const Buffer file = small_file();
    const auto tree = read_chunk_tree(file);
    ASSERT_TRUE(tree.has_value());
    EXPECT_EQ(as_text(tree->payload(1)), "hello");
    EXPECT_EQ(tree->payload(1).data(), file.data() + 32);
    EXPECT_EQ(tree->payload(3).size(), 0u);
    EXPECT_EQ(tree->payload(2).size(), 32u);
}

TEST(ChunkReader, WalksDirectChildrenOnly) {
    const Buffer file = small_file();
    const auto tree = read_chunk_tree(file);
    ASSERT_TRUE(tree.has_value());
    std::vector<std::uint32_t> children;
    for (const std::uint32_t number : tree->children(0)) children.push_back(number);
    EXPECT_EQ(children, (std::vector<std::uint32_t>{1, 2, 5}));
    for (const std::uint32_t childless : {1u, 3u, 4u, 5u}) {
        EXPECT_TRUE(tree->children(childless).begin() == tree->children(childless).end()) << childless;
    }
}

TEST(ChunkReader, FindsTheFirstDirectChildWithAnId) {
    const Buffer file = small_file();
    const auto tree = read_chunk_tree(file);
    ASSERT_TRUE(tree.has_value());
    EXPECT_EQ(tree->find(0, FourCC("AAAA")), 1u);
    EXPECT_EQ(tree->find(0, FourCC("CCCC")), kNone);
    EXPECT_EQ(tree->find(2, FourCC("CCCC")), 3u);
    EXPECT_EQ(tree->find(1, FourCC("AAAA")), kNone);
}

TEST(ChunkReader, ReadsARootWithoutChildren) {
    const Buffer file = to_file(make_container(FourCC("HEAD")));
    const auto tree = read_chunk_tree(file);
    ASSERT_TRUE(tree.has_value());
    EXPECT_EQ(tree->chunks().size(), 1u);
    EXPECT_TRUE(tree->children(0).begin() == tree->children(0).end());
}

TEST(ChunkReader, RefusesABufferThatIsNotAligned) {
    const Buffer file = small_file();
    Buffer shifted(file.size() + 16);
    for (std::size_t skew = 1; skew < 16; ++skew) {
        std::copy(file.begin(), file.end(), shifted.begin() + static_cast<std::ptrdiff_t>(skew));
        expect_refused(Bytes(shifted).subspan(skew, file.size()), ErrorCode::kUnalignedBuffer, 0);
    }
}

TEST(ChunkReader, RefusesWhatIsTooShortForAHeader) {
    const Buffer file = small_file();
    for (std::size_t size = 0; size < 16; ++size) {
        const Buffer cut(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size));
        expect_refused(cut, ErrorCode::kNotABendyFile, 0);
    }
    expect_refused({}, ErrorCode::kNotABendyFile, 0);
}

TEST(ChunkReader, RefusesAnotherRoot) {
    expect_refused(to_file(make_container(FourCC("RIFF"))), ErrorCode::kNotABendyFile, 0);
    expect_refused(to_file(make_leaf(FourCC("HEAD"))), ErrorCode::kNotAContainer, 0);
}

TEST(ChunkReader, RefusesAFileThatEndsEarly) {
    Buffer file = small_file();
    file.resize(file.size() - 1);
    const auto tree = read_chunk_tree(file);
    ASSERT_FALSE(tree.has_value());
    EXPECT_EQ(tree.error().code, ErrorCode::kTruncated);
    EXPECT_EQ(tree.error().value, 112u);
    EXPECT_EQ(tree.error().limit, 111u);
}

TEST(ChunkReader, RefusesBytesAfterTheRoot) {
    Buffer file = small_file();
    const std::size_t end = file.size();
    file.resize(end + 1);
    expect_refused(file, ErrorCode::kTrailingBytes, end);
    file.resize(end + 160);
    expect_refused(file, ErrorCode::kTrailingBytes, end);
}

TEST(ChunkReader, RefusesAChunkThatRunsPastItsContainer) {
    const std::uint64_t empty_leaf = 64;
    const Buffer good = small_file();
    Buffer file = good;
    patch(file, empty_leaf + 8, pack_size_and_flags(17, 0));  // its container has 16 bytes left
    expect_refused(file, ErrorCode::kChunkTooLong, empty_leaf);
    file = good;
    patch(file, empty_leaf + 8, pack_size_and_flags(16, 0));  // as long as can be: swallows its sibling
    patch(file, empty_leaf + 16, std::uint64_t{0});
    EXPECT_TRUE(read_chunk_tree(file).has_value());
}

TEST(ChunkReader, RefusesHugeSizes) {
    for (const std::uint64_t size : {kMaxPayload, kMaxPayload - 15, std::uint64_t{1} << 47, std::uint64_t{1} << 32}) {
        for (const std::uint16_t flags : {std::uint16_t{0}, std::uint16_t{kContainerFlag}}) {
            Buffer file = small_file();
            patch(file, 48 + 8, pack_size_and_flags(size, flags));
            const auto tree = read_chunk_tree(file);
            ASSERT_FALSE(tree.has_value()) << size << ' ' << flags;
            EXPECT_EQ(tree.error().code,
                      flags != 0 && size % 16 != 0 ? ErrorCode::kContainerSize : ErrorCode::kChunkTooLong);
            file = small_file();
            patch(file, 8, pack_size_and_flags(size, kContainerFlag));
            ASSERT_FALSE(read_chunk_tree(file).has_value()) << size;
        }
    }
}

TEST(ChunkReader, RefusesAContainerThatIsShorterThanItsChildren) {
    Buffer file = small_file();
    patch(file, 48 + 8, pack_size_and_flags(16, kContainerFlag));
    // Its second child now stands beside it, which is still a tree; cut the first child's room instead.
    ASSERT_TRUE(read_chunk_tree(file).has_value());
    patch(file, 64 + 8, pack_size_and_flags(1, 0));
    expect_refused(file, ErrorCode::kChunkTooLong, 64);
}

TEST(ChunkReader, RefusesContainerSizesOffTheBoundary) {
    for (std::uint64_t size = 17; size < 32; ++size) {
        Buffer file = small_file();
        patch(file, 48 + 8, pack_size_and_flags(size, kContainerFlag));
        expect_refused(file, ErrorCode::kContainerSize, 48);
    }
}

TEST(ChunkReader, RefusesReservedFlags) {
    for (unsigned bit = 2; bit < 8; ++bit) {
        for (const std::uint64_t offset : {0u, 16u, 48u}) {
            Buffer file = small_file();
            std::uint64_t field = 0;
            copy_at(file, offset + 8, field);
            patch(file, offset + 8, field | std::uint64_t{1} << (48 + bit));
            expect_refused(file, ErrorCode::kReservedFlags, offset);
        }
    }
}

TEST(ChunkReader, RefusesEncodedContainersButNotEncodedLeaves) {
    Buffer file = small_file();
    patch(file, 48 + 8, pack_size_and_flags(32, 0x0100 | kContainerFlag));
    expect_refused(file, ErrorCode::kContainerCodec, 48);
    file = small_file();
    patch(file, 16 + 8, pack_size_and_flags(5, 0xff00));
    const auto tree = read_chunk_tree(file);
    ASSERT_TRUE(tree.has_value());
    EXPECT_EQ((*tree)[1].codec(), 0xffu);
}

TEST(ChunkReader, RefusesIdsThatCannotBeRead) {
    for (const char letter : {'\0', ' ', '/', ':', '@', '[', 'a', '\x7f', '\xff'}) {
        for (std::uint64_t place = 0; place < 4; ++place) {
            Buffer file = small_file();
            patch(file, 16 + place, letter);
            expect_refused(file, ErrorCode::kChunkIdNotLetters, 16);
        }
    }
    for (const char letter : {'0', '9', 'A', 'Z'}) {
        Buffer file = small_file();
        patch(file, 16 + 3, letter);
        EXPECT_TRUE(read_chunk_tree(file).has_value()) << letter;
    }
}

TEST(ChunkReader, RefusesPaddingThatIsNotZero) {
    for (std::uint64_t at = 37; at < 48; ++at) {
        Buffer file = small_file();
        patch(file, at, std::byte{0x80});
        expect_refused(file, ErrorCode::kPaddingNotZero, 37);
    }
}

TEST(ChunkReader, TakesContainersDownToTheLowestLevelAndNoFurther) {
    const auto nested = [](std::uint32_t levels) {
        ChunkWriter writer;
        writer.begin(FourCC("HEAD"));
        for (std::uint32_t level = 1; level < levels; ++level) writer.begin(FourCC("AAAA"));
        for (std::uint32_t level = 0; level < levels; ++level) writer.end();
        return std::move(writer).finish();
    };
    const Buffer deepest = nested(kMaxDepth);
    const auto tree = read_chunk_tree(deepest);
    ASSERT_TRUE(tree.has_value());
    EXPECT_EQ(tree->chunks().size(), kMaxDepth);
    for (std::uint32_t number = 1; number < kMaxDepth; ++number) ASSERT_EQ((*tree)[number].parent, number - 1);
    expect_refused(nested(kMaxDepth + 1), ErrorCode::kTooDeep, std::uint64_t{kMaxDepth} * kChunkHeaderSize);
    expect_refused(nested(kMaxDepth * 4), ErrorCode::kTooDeep, std::uint64_t{kMaxDepth} * kChunkHeaderSize);
}

TEST(ChunkReader, HasALimitOfChunks) {
    const Buffer file = small_file();
    const auto tree = walk_chunks(file, 6);
    ASSERT_TRUE(tree.has_value());
    EXPECT_EQ(tree->chunks().size(), 6u);
    const auto refused = walk_chunks(file, 5);
    ASSERT_FALSE(refused.has_value());
    EXPECT_EQ(refused.error().code, ErrorCode::kTooManyChunks);
    EXPECT_EQ(refused.error().offset, place_of(file, "HEAD/AAAA[1]"));
    EXPECT_EQ(refused.error().limit, 5u);
}

TEST(FourCC, IsStoredInReadingOrder) {
    EXPECT_EQ(FourCC("HEAD").value, 0x44414548u);
    EXPECT_STREQ(FourCC("HEAD").letters().data(), "HEAD");
    EXPECT_STREQ(FourCC(0x20ff0041u).letters().data(), "A???");
}

}  // namespace
}  // namespace bendy::chunk_reader_test
