#include "round_trip.h"

#include "conformance/cases.h"
#include "format/edit_file.h"
#include "format/packed_samples.h"
#include "format/sample_file.h"
#include "source_folder.h"

#include <bendy/format/chunk_reader.h>
#include <bendy/format/codec.h>
#include <bendy/format/document.h>
#include <bendy/format/file.h>
#include <bendy/format/packed_clip.h>

#include <bit>
#include <cmath>
#include <filesystem>
#include <limits>
#include <random>

namespace bendy::test::round_trip_test {
namespace {

TEST(RoundTrip, FilesOfTheSpecification) {
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(source_folder() / "spec/examples")) {
        if (entry.path().extension() != ".bendy") continue;
        SCOPED_TRACE(entry.path());
        const auto file = MappedFile::open(entry.path());
        ASSERT_TRUE(file);
        expect_same_bytes(file->bytes());
        ++files;
    }
    EXPECT_GE(files, 4u);
}

TEST(RoundTrip, EveryConformanceFileThatCanBeWalked) {
    std::size_t files = 0;
    for (const conformance::Case& one : conformance::read_cases(source_folder() / "tests/conformance")) {
        SCOPED_TRACE(one.name);
        const auto tree = read_chunk_tree(one.bytes);
        Faults faults;
        if (tree) check_sums(*tree, faults);
        if (!tree || !faults.empty()) continue;
        expect_same_bytes(one.bytes);
        ++files;
    }
    EXPECT_GE(files, 100u);
}

TEST(RoundTrip, TheSampleFile) {
    expect_same_bytes(sample_file());
    const std::string text = dumped(sample_file());
    for (const char* part : {"\"more\"", "\"hex\"", ": null"}) EXPECT_EQ(text.find(part), std::string::npos) << part;
    EXPECT_NE(text.find("\"targets_0\": [1]"), std::string::npos);
}

TEST(RoundTrip, EveryLeafCutShortAndMadeLonger) {
    const Buffer file = sample_file();
    const auto tree = read_chunk_tree(file);
    ASSERT_TRUE(tree);
    const std::vector<std::byte> longer(3, std::byte{0x5a});
    for (std::uint32_t number = 0; number < tree->chunks().size(); ++number) {
        const Chunk& chunk = (*tree)[number];
        if (chunk.is_container()) continue;
        for (std::uint64_t size = 0; size <= chunk.size + 1; ++size) {
            SCOPED_TRACE(std::string(chunk.id.letters().data()) + ' ' + std::to_string(size));
            const Bytes kept = tree->stored(number).subspan(0, std::min(size, chunk.size));
            ChunkWriter writer;
            writer.begin(FourCC("HEAD"));
            const Bytes pieces[] = {kept, size > chunk.size ? Bytes(longer) : Bytes()};
            writer.leaf(chunk.id, pieces, kRequiredFlag);
            writer.end();
            expect_same_bytes(std::move(writer).finish());
        }
    }
}

/// In place, so that counts and types stop fitting what they count.
TEST(RoundTrip, EveryByteOfEveryRecordChanged) {
    const Buffer file = sample_file();
    const auto tree = read_chunk_tree(file);
    ASSERT_TRUE(tree);
    constexpr std::uint64_t kFirstBytes = 32;
    for (const Chunk& chunk : tree->chunks()) {
        if (chunk.is_container()) continue;
        for (std::uint64_t at = 0; at < std::min(chunk.size, kFirstBytes); at += 2) {
            for (const unsigned value : {0u, 2u, 0xffu}) {
                if (file[chunk.payload_offset() + at] == static_cast<std::byte>(value)) continue;
                Buffer changed = file;
                changed[chunk.payload_offset() + at] = static_cast<std::byte>(value);
                ASSERT_TRUE(resum(changed));
                expect_same_bytes(changed);
                if (HasFailure()) FAIL() << chunk.id.letters().data() << " + " << at << " = " << value;
            }
        }
    }
}

TEST(RoundTrip, IdsInOtherPlacesAndShapes) {
    Node root = make_container(FourCC("HEAD"));
    for (const char* id : {"NAME", "SKIN", "VERS", "LODD", "KEYV", "PACK", "JNAM", "MARK", "XTRA", "HEAD", "0000"}) {
        std::uint32_t letters = 0;
        std::memcpy(&letters, id, sizeof letters);
        const auto payload = as_byte_span("some text that is nothing else: \x80");
        root.children.push_back(make_leaf(FourCC(letters), payload));
        root.children.push_back(make_leaf(FourCC(letters)));
        root.children.push_back(make_leaf(FourCC(letters), payload, kRequiredFlag));
        root.children.push_back(make_container(FourCC(letters), {}, kRequiredFlag));
        root.children.push_back(make_container(FourCC(letters), {make_leaf(FourCC(letters), payload)}));
    }
    expect_same_bytes(to_file(root));
}

TEST(RoundTrip, NumbersThatJsonHasNoWordsFor) {
    std::vector<std::uint32_t> bits{0x7f800000u, 0xff800000u, 0x7fc00000u, 0xffc00001u, 0x7f800001u, 0x80000000u,
                                    0x00000001u, 0x807fffffu, 0x00800000u, 0x7f7fffffu, 0x3dcccccdu, 0x4b800001u};
    std::mt19937 random(7);  // NOLINT(cert-msc51-cpp): the same numbers every time
    for (int k = 0; k < 20000; ++k) bits.push_back(static_cast<std::uint32_t>(random()));
    Node root = make_container(FourCC("HEAD"), {make_leaf(FourCC("TIME"), bytes_of_all(bits))});
    const Buffer file = to_file(root);
    expect_same_bytes(file);
    const std::string text = dumped(file);
    EXPECT_NE(text.find("\"inf\", \"-inf\", \"nan:0x7fc00000\", \"nan:0xffc00001\", \"nan:0x7f800001\", -0.0, 1e-45"),
              std::string::npos)
        << text.substr(0, 300);
}

/// For other JSON readers, -0 is an integer, which has no sign.
TEST(RoundTrip, ANegativeZeroIsNoInteger) {
    const std::vector<float> zero{-0.0f};
    const Buffer file = to_file(make_container(FourCC("HEAD"), {make_leaf(FourCC("TIME"), bytes_of_all(zero))}));
    EXPECT_EQ(assembled(edited(dumped(file), "-0.0", "-0")), file);
}

TEST(RoundTrip, NamesOfAllKinds) {
    using namespace std::string_view_literals;
    Node root = make_container(FourCC("HEAD"));
    for (const std::string_view name :
         {""sv, "plain"sv, "\"quoted\" \\ / \b\f\n\r\t\x01\x1f\x7f"sv, "a\0b"sv, "\0"sv,
          "H\xc3\xbcgel \xe2\x82\xac \xf0\x9f\xa6\x8a"sv, "\xff\xfe"sv, "\xed\xa0\x80"sv}) {
        for (const char* id : {"NAME", "EXTR", "JNAM", "LINK"}) {
            std::uint32_t letters = 0;
            std::memcpy(&letters, id, sizeof letters);
            root.children.push_back(make_leaf(FourCC(letters), as_byte_span(name)));
        }
        root.children.push_back(
            make_leaf(FourCC("JNAM"), as_byte_span(std::string(name) + '\0' + std::string(name) + '\0')));
    }
    expect_same_bytes(to_file(root));
}

TEST(RoundTrip, SixtyFiveThousandNestedJoints) {
    const Buffer file = rope_file(65000);
    const std::string text = dumped(file);
    EXPECT_LT(text.size(), 400 * std::size_t{65000});
    const auto again = assembled(text);
    EXPECT_TRUE(file == again);
}

/// Were a mesh looked for among all others, this would take minutes.
TEST(RoundTrip, ACollapseSequenceOfTwentyThousandMeshes) {
    constexpr std::uint32_t kMeshes = 20000;
    Node object = make_container(FourCC("OBJE"));
    std::vector<std::byte> sequence(16 + kMeshes * std::size_t{16 + 32});
    const CollapseRecord collapse{kMeshes, 0, {}};
    std::memcpy(sequence.data(), &collapse, sizeof collapse);
    for (std::uint32_t k = 0; k < kMeshes; ++k) {
        const MeshRecord mesh{2, kNone};
        object.children.push_back(make_container(FourCC("VECT"), {make_leaf(FourCC("VINF"), bytes_of(mesh))}));
        const MeshCollapseRecord record{k, 1, 2, {}};
        std::memcpy(sequence.data() + 16 + k * std::size_t{16}, &record, sizeof record);
    }
    object.children.push_back(make_leaf(FourCC("LODD"), sequence));
    const Buffer file = to_file(make_container(FourCC("HEAD"), {std::move(object)}));
    const std::string text = dumped(file);
    EXPECT_NE(text.find("\"joined_19999\""), std::string::npos);
    EXPECT_TRUE(assembled(text) == file);
}

TEST(RoundTrip, EncodedLeavesKeepTheirBytes) {
    std::vector<float> values;
    for (int k = 0; k < 3000; ++k) values.push_back(std::round(100.0f * std::sin(static_cast<float>(k))) / 8.0f);
    const Bytes payload = bytes_of_all(values);
    const auto zstd = encode_payload(Codec::zstd, payload, 0, 4);
    const auto rows = encode_payload(Codec::vertices_zstd, payload, 0, 12);
    ASSERT_TRUE(zstd && rows);
    Node root = make_container(FourCC("HEAD"));
    const auto flags = [](Codec codec) { return static_cast<std::uint16_t>(static_cast<unsigned>(codec) << 8); };
    root.children.push_back(make_leaf(FourCC("KEYV"), *zstd, flags(Codec::zstd)));
    root.children.push_back(make_leaf(FourCC("KEYV"), *rows, flags(Codec::vertices_zstd)));
    root.children.push_back(make_leaf(FourCC("KEYV"), *zstd, flags(Codec::sums)));  // damaged
    root.children.push_back(make_leaf(FourCC("KEYV"), *zstd, 0x4200));              // unknown codec
    root.children.push_back(make_leaf(FourCC("XTRA"), *zstd, flags(Codec::zstd)));  // unknown chunk
    root.children.push_back(make_leaf(FourCC("KEYV"), {}, flags(Codec::zstd)));
    expect_same_bytes(to_file(root));
}

TEST(RoundTrip, DecodedLeavesAreStoredPlainly) {
    std::vector<float> values;
    for (int k = 0; k < 2000; ++k) values.push_back(0.25f * static_cast<float>(k));
    const auto zstd = encode_payload(Codec::zstd, bytes_of_all(values), 0, 4);
    ASSERT_TRUE(zstd);
    const Node encoded = make_container(FourCC("HEAD"), {make_leaf(FourCC("KEYV"), *zstd, 0x0100)});
    const Node plain = make_container(FourCC("HEAD"), {make_leaf(FourCC("KEYV"), bytes_of_all(values))});
    text_form::DumpOptions options;
    options.decode = true;
    EXPECT_EQ(assembled(dumped(to_file(encoded), options)), to_file(plain));
}

}  // namespace
}  // namespace bendy::test::round_trip_test
