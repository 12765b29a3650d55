#include <bendy/format/chunk_reader.h>

#include "edit_file.h"

#include <bendy/format/codec.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

namespace bendy::test::decode_leaves_test {
namespace {

constexpr std::uint16_t kZstd = 0x0100;

void encode(Node& leaf, std::uint16_t stride) {
    const auto encoded = encode_payload(Codec::zstd, leaf.payload, 0, stride);
    ASSERT_TRUE(encoded.has_value());
    leaf.payload.assign(encoded->begin(), encoded->end());
    leaf.flags = kZstd;
}

struct Decoded {
    explicit Decoded(const Node& root) : file(to_file(root)), tree(*read_chunk_tree(file)) { decode_leaves(tree); }

    [[nodiscard]] std::uint32_t number(std::string_view path) const {
        std::uint32_t at = 0;
        for (std::size_t slash = path.find('/'); slash != std::string_view::npos; slash = path.find('/', slash + 1)) {
            FourCC id;
            copy_at(as_byte_span(path.substr(slash + 1, 4)), 0, id);
            at = tree.find(at, id);
        }
        return at;
    }

    Buffer file;
    ChunkTree tree;
};

TEST(DecodeLeaves, GivesEveryReaderWhatTheLeafMeans) {
    Node root = sample();
    const Node plain = root;
    for (const char* path : {"HEAD/OBJE/NAME", "HEAD/OBJE/VECT/POSI", "HEAD/OBJE/VECT/PALT", "HEAD/OBJE/CYCL/KEYV"})
        encode(at(root, path), 4);
    EXPECT_EQ(validate(to_file(root)).count(), 0u);
    const Decoded decoded(root);
    for (const char* path : {"HEAD/OBJE/NAME", "HEAD/OBJE/VECT/POSI", "HEAD/OBJE/VECT/PALT", "HEAD/OBJE/CYCL/KEYV"}) {
        const std::uint32_t number = decoded.number(path);
        Node copy = plain;
        const Buffer& expected = at(copy, path).payload;
        const Bytes payload = decoded.tree.payload(number);
        EXPECT_TRUE(std::equal(payload.begin(), payload.end(), expected.begin(), expected.end())) << path;
        EXPECT_FALSE(decoded.tree.encoding_fault(number)) << path;
    }
}

TEST(DecodeLeaves, SaysWhyALeafIsEmpty) {
    Node root = sample();
    Node& name = at(root, "HEAD/OBJE/NAME");
    encode(name, 0);
    name.payload[sizeof(CodecHeader)] ^= std::byte{0xff};  // of the frame's magic number
    const Decoded decoded(root);
    const std::uint32_t number = decoded.number("HEAD/OBJE/NAME");
    ASSERT_TRUE(decoded.tree.encoding_fault(number));
    EXPECT_EQ(decoded.tree.encoding_fault(number)->code, ErrorCode::kCodecData);
    EXPECT_TRUE(decoded.tree.payload(number).empty());
}

TEST(DecodeLeaves, LeavesUnknownChunksAlone) {
    Node root = sample();
    root.children.push_back(
        make_leaf(FourCC("ZZZ1"), as_byte_span("not zstd at all, and none of our business"), kZstd));
    EXPECT_EQ(validate(to_file(root)).count(), 0u);

    // Among leaves that are decoded, too.
    std::rotate(root.children.begin(), root.children.end() - 1, root.children.end());
    encode(at(root, "HEAD/OBJE/NAME"), 0);
    const Decoded decoded(root);
    const std::uint32_t number = decoded.number("HEAD/ZZZ1");
    EXPECT_EQ(as_text(decoded.tree.payload(number)), "not zstd at all, and none of our business");
    ASSERT_TRUE(decoded.tree.encoding_fault(number));
    EXPECT_EQ(decoded.tree.encoding_fault(number)->code, ErrorCode::kUnsupportedCodec);
}

TEST(DecodeLeaves, EveryPrefixOfAnEncodedLeafIsAFault) {
    Node root = sample();
    Node& positions = at(root, "HEAD/OBJE/VECT/POSI");
    encode(positions, 4);
    const Buffer whole = positions.payload;
    for (std::size_t size = 0; size < whole.size(); ++size) {
        positions.payload.assign(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
        const Faults faults = validate(to_file(root));
        ASSERT_FALSE(faults.empty()) << size;
    }
}

}  // namespace
}  // namespace bendy::test::decode_leaves_test
