#include <bendy/format/diagnostics.h>

#include "edit_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <set>
#include <string>

namespace bendy::diagnostics_test {
namespace {

using namespace test;

TEST(ChunkPath, NamesEveryChunkSoThatItIsFoundAgain) {
    const Loaded sample(sample_file());
    std::set<std::string> paths;
    for (std::uint32_t number = 0; number < sample.tree.chunks().size(); ++number) {
        const Chunk& chunk = sample.tree[number];
        const std::string path = chunk_path(sample.file, chunk.offset);
        EXPECT_EQ(find_path(sample.tree, path), number) << path;
        paths.insert(path);
    }
    EXPECT_EQ(paths.size(), sample.tree.chunks().size());
}

TEST(ChunkPath, CountsAmongSiblingsOfTheSameId) {
    const Loaded sample(sample_file());
    const auto path = [&](const char* of) { return chunk_path(sample.file, place_of(sample.file, of)); };
    EXPECT_EQ(path("HEAD"), "HEAD");
    EXPECT_EQ(path("HEAD[0]/OBJE[0]/SKIN[0]/SKIN[1]/PIVO"), "HEAD/OBJE/SKIN/SKIN[1]/PIVO");
    EXPECT_EQ(path("HEAD/TEXT[2]/SAME"), "HEAD/TEXT[2]/SAME");
    EXPECT_EQ(path("HEAD/OBJE/VECT[1]/INDX"), "HEAD/OBJE/VECT[1]/INDX");
}

TEST(ChunkPath, HoldsForEveryByteOfAChunk) {
    const Loaded sample(sample_file());
    for (std::uint64_t offset = 0; offset < sample.file.size(); ++offset) {
        std::uint32_t innermost = 0;
        for (std::uint32_t number = 0; number < sample.tree.chunks().size(); ++number) {
            const Chunk& chunk = sample.tree[number];
            if (offset >= chunk.offset && offset < chunk.payload_offset() + padded(chunk.size)) innermost = number;
        }
        ASSERT_EQ(find_path(sample.tree, "@" + std::to_string(offset)), innermost) << offset;
        ASSERT_EQ(find_path(sample.tree, chunk_path(sample.file, offset)), innermost) << offset;
    }
}

TEST(ChunkPath, IsShortenedInTheMiddle) {
    const auto deepest = [](std::uint32_t joints) {
        const Buffer file = rope_file(joints);
        const auto tree = read_chunk_tree(file);
        std::uint64_t offset = 0;
        for (const Chunk& chunk : tree->chunks()) {
            if (chunk.id == FourCC("REST")) offset = chunk.offset;
        }
        return chunk_path(file, offset);
    };
    EXPECT_EQ(deepest(1), "HEAD/OBJE/SKIN/PIVO/REST");
    EXPECT_EQ(deepest(9), "HEAD/OBJE/SKIN/SKIN/SKIN/SKIN/SKIN/SKIN/SKIN/SKIN/SKIN/PIVO/REST");
    EXPECT_EQ(deepest(10), "HEAD/OBJE/SKIN/SKIN/SKIN/SKIN/... 2 more .../SKIN/SKIN/SKIN/SKIN/PIVO/REST");
    EXPECT_EQ(deepest(10'000), "HEAD/OBJE/SKIN/SKIN/SKIN/SKIN/... 9992 more .../SKIN/SKIN/SKIN/SKIN/PIVO/REST");
}

TEST(ChunkPath, IsWholeWhereProgramsReadIt) {
    const Loaded rope(rope_file(10'000));
    const std::uint64_t offset = rope.tree.chunks().back().offset;
    const std::string whole = whole_chunk_path(rope.file, offset);
    EXPECT_EQ(std::count(whole.begin(), whole.end(), '/'), 10'003);
    EXPECT_EQ(rope.tree[find_path(rope.tree, whole)].offset, offset);
    const Loaded sample(sample_file());
    for (const Chunk& chunk : sample.tree.chunks())
        EXPECT_EQ(whole_chunk_path(sample.file, chunk.offset), chunk_path(sample.file, chunk.offset));
}

TEST(ChunkPath, WorksAsFarAsHeadersCanBeTrusted) {
    Buffer file = sample_file();
    const std::uint64_t skin = place_of(file, "HEAD/OBJE/SKIN/SKIN[1]");
    patch(file, skin + 8, pack_size_and_flags(kMaxPayload, kContainerFlag));
    EXPECT_EQ(chunk_path(file, skin), "HEAD/OBJE/SKIN/SKIN[1]");
    file.resize(skin + 4);
    EXPECT_EQ(chunk_path(file, 16), "HEAD/VERS");
    EXPECT_EQ(chunk_path({}, 0), "");
    EXPECT_EQ(chunk_path(Bytes(file).first(15), 3), "");
}

TEST(ChunkPath, EndsWhereAnIdCannotBeRead) {
    Buffer file = sample_file();
    const std::uint64_t skin = place_of(file, "HEAD/OBJE/SKIN");
    patch(file, skin, std::uint32_t{0});
    const std::string there = chunk_path(file, skin);
    EXPECT_EQ(chunk_path(file, skin + kChunkHeaderSize), there);
    EXPECT_EQ(std::count(there.begin(), there.end(), '/'), 2);
}

TEST(ChunkPath, NamesALeafWhosePaddingIsCutOff) {
    Buffer file = sample_file();
    const std::uint64_t last = place_of(file, "HEAD/EXTR");
    file.pop_back();
    EXPECT_EQ(chunk_path(file, last), "HEAD/EXTR");
    EXPECT_EQ(chunk_path(file, file.size() - 1), "HEAD/EXTR");
}

TEST(ChunkPath, EndsForEveryOffsetOfBytesThatAreNoFile) {
    Buffer noise(333);
    std::uint32_t state = 7;
    for (std::byte& byte : noise) {
        state = state * 1664525u + 1013904223u;
        byte = static_cast<std::byte>(state >> 24);
    }
    const Buffer zeros(333);
    for (std::uint64_t offset = 0; offset < 400; ++offset) {
        EXPECT_LE(chunk_path(noise, offset).size(), 400u);
        EXPECT_LE(chunk_path(zeros, offset).size(), 400u);
    }
    EXPECT_LE(chunk_path(noise, ~std::uint64_t{0}).size(), 400u);
}

TEST(FindPath, RefusesWhatNamesNoChunk) {
    const Loaded sample(sample_file());
    for (const char* path : {"",
                             "/",
                             "HEAD/",
                             "/HEAD",
                             "OBJE",
                             "HEAD[1]",
                             "HEAD/OBJE[1]",
                             "HEAD/obje",
                             "HEAD/OBJ",
                             "HEAD/OBJEC",
                             "HEAD/OBJE[",
                             "HEAD/OBJE[]",
                             "HEAD/OBJE[0",
                             "HEAD/OBJE[x]",
                             "HEAD/OBJE[0]x",
                             "HEAD/OBJE[-1]",
                             "HEAD/OBJE[0x]",
                             "HEAD/OBJECTS",
                             "HEAD/OBJE[99999999999]",
                             "HEAD/VERS/NAME",
                             "HEAD//OBJE",
                             "@",
                             "@x",
                             "@-1",
                             "@1x",
                             "@99999999999999999999"}) {
        EXPECT_EQ(find_path(sample.tree, path), kNone) << path;
    }
    EXPECT_EQ(find_path(sample.tree, "@" + std::to_string(sample.file.size())), kNone);
}

TEST(FindPath, FindsByOffset) {
    const Loaded sample(sample_file());
    EXPECT_EQ(find_path(sample.tree, "@0"), 0u);
    EXPECT_EQ(find_path(sample.tree, "@16"), 1u);
    EXPECT_EQ(find_path(sample.tree, "@47"), 1u);
}

/// Some bytes to name a place in.
Error fault(ErrorCode code, std::uint64_t value = 0, std::uint64_t limit = 0) {
    return {code, 16, value, limit};
}

TEST(Describe, FillsInTheNumbers) {
    EXPECT_EQ(describe(fault(ErrorCode::kChunkTooLong, 96, 48)),
              "the chunk's payload of 96 bytes does not fit the 48 bytes left in its container");
    EXPECT_EQ(describe(fault(ErrorCode::kRecordTooShort, 3, ~std::uint64_t{0})),
              "the record is too short: expected at least 18446744073709551615 bytes, found 3");
}

TEST(Describe, ShowsSumsAndFlagsInHexadecimalAndIdsInLetters) {
    EXPECT_EQ(describe(fault(ErrorCode::kSumMismatch, 0xdeadbeef)),
              "the checksum does not match the content: expected 0xdeadbeef");
    EXPECT_EQ(describe(fault(ErrorCode::kReservedFlags, 0xfc)), "reserved flag bits are set: 0xfc");
    EXPECT_EQ(describe(fault(ErrorCode::kChunkMissing, FourCC("PIVO").value)),
              "the container lacks a required chunk: PIVO");
}

TEST(Describe, SaysWhatTheSystemSaid) {
    EXPECT_EQ(describe(fault(ErrorCode::kCannotOpen, ENOENT)),
              "the file cannot be opened: " + std::string(std::strerror(ENOENT)));
}

TEST(Describe, LeavesNoMarkUnfilled) {
    unsigned codes = 0;
#define BENDY_ERROR(enumerator, kind, code, text)                                                 \
    EXPECT_EQ(describe(fault(ErrorCode::enumerator, 1, 2)).find('{'), std::string::npos) << code; \
    EXPECT_STREQ(code_name(ErrorCode::enumerator), code);                                         \
    EXPECT_STREQ(error_text(ErrorCode::enumerator), text);                                        \
    EXPECT_EQ(error_class(ErrorCode::enumerator), ErrorClass::kind) << code;                      \
    ++codes;
#include <bendy/format/error_codes.def>
#undef BENDY_ERROR
    EXPECT_GT(codes, 50u);
}

TEST(Describe, AddsPathAndOffset) {
    const Buffer file = sample_file();
    EXPECT_EQ(describe_with_place(fault(ErrorCode::kSignature), file),
              "the signature in VERS is wrong: the file was damaged by a text-mode transfer, or is not a Bendy file "
              "(HEAD/VERS, offset 16)");
    EXPECT_EQ(describe_with_place(fault(ErrorCode::kNotABendyFile), {}),
              "this is not a bendy file: it does not start with a HEAD chunk (offset 16)");
    EXPECT_EQ(describe_with_place(fault(ErrorCode::kCannotOpen, ENOENT), file),
              describe(fault(ErrorCode::kCannotOpen, ENOENT)));
}

TEST(ErrorCodes, AreUniqueAndSpelledAlike) {
    std::set<std::string> names;
#define BENDY_ERROR(enumerator, kind, code, text)   \
    EXPECT_TRUE(names.insert(code).second) << code; \
    EXPECT_EQ(std::string(code).find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_"), std::string::npos) << code;
#include <bendy/format/error_codes.def>
#undef BENDY_ERROR
}

}  // namespace
}  // namespace bendy::diagnostics_test
