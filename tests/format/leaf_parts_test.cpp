#include <bendy/format/leaf_parts.h>

#include "edit_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>
#include <string>
#include <vector>

namespace bendy::leaf_parts_test {
namespace {

using namespace test;

template <class T>
void append(Buffer& payload, const T& value) {
    const Bytes bytes = bytes_of(value);
    payload.insert(payload.end(), bytes.begin(), bytes.end());
}

/// Name, type, offset and count of each part.
std::vector<std::string> lines_of(const char* chunk, const Buffer& payload) {
    std::uint32_t raw = 0;
    std::memcpy(&raw, chunk, sizeof raw);
    std::vector<std::string> lines;
    const LocatedParts parts = locate_parts(*find_leaf(FourCC(raw)), payload);
    for (const LocatedPart& part : parts.list) {
        const bool has_type = part.part->kind == PartKind::numbers;
        lines.push_back(std::string(part.part->name) + (has_type ? " " + std::string(name_of(part.shape.type)) : "") +
                        " @" + std::to_string(part.offset) + " x" + std::to_string(part.shape.count));
    }
    if (!parts.is_whole) lines.emplace_back("cut");
    if (parts.end != payload.size()) lines.push_back(std::to_string(payload.size() - parts.end) + " more");
    return lines;
}

using Lines = std::vector<std::string>;

TEST(LeafParts, FollowOneAnother) {
    Buffer palette;
    append(palette, PaletteRecord{3, 0, {}});
    palette.resize(16 + 16 + 3 * 64);  // three joints, and zeros for a fourth
    EXPECT_EQ(lines_of("PALT", palette), (Lines{" @0 x1", "joints u32 @16 x3", "matrices f32 @32 x48"}));
    const std::uint32_t derived = 1;
    std::memcpy(palette.data() + 4, &derived, sizeof derived);
    EXPECT_EQ(lines_of("PALT", palette), (Lines{" @0 x1", "joints u32 @16 x3", "matrices f32 @32 x16", "128 more"}));
}

TEST(LeafParts, HaveTheTypeThatTheRecordSays) {
    Buffer stream;
    append(stream, StreamRecord{2, 2, 3, 2, 0, 0});  // boxed u16 x 3, two of them
    stream.resize(16 + 32 + 12);
    EXPECT_EQ(lines_of("POSI", stream), (Lines{" @0 x1", "box f32 @16 x6", "values u16 @48 x6"}));
    stream[1] = std::byte{0};
    EXPECT_EQ(lines_of("POSI", stream), (Lines{" @0 x1", "values u16 @16 x6", "32 more"}));
    stream[0] = std::byte{6};
    EXPECT_EQ(lines_of("POSI", stream), (Lines{" @0 x1", "cut", "44 more"}));
}

TEST(LeafParts, GoToThePayloadsEndWhereTheyAreTheRest) {
    EXPECT_EQ(lines_of("TRAK", Buffer(3 * sizeof(TrackRecord))), Lines{"tracks @0 x3"});
    EXPECT_EQ(lines_of("TRAK", Buffer(3 * sizeof(TrackRecord) + 1)), (Lines{"tracks @0 x3", "1 more"}));
    EXPECT_EQ(lines_of("NAME", Buffer(5)), Lines{"text @0 x5"});
    EXPECT_EQ(lines_of("PACK", Buffer(30)), (Lines{" @0 x1", "tracks @20 x0"}));
}

TEST(LeafParts, EndWithARecordThatIsCut) {
    EXPECT_EQ(lines_of("REST", Buffer(52)), Lines{" @0 x1"});
    EXPECT_EQ(lines_of("REST", Buffer(40)), Lines{" @0 x1"});  // the shortest form
    EXPECT_EQ(lines_of("REST", Buffer(41)), (Lines{"cut", "41 more"}));
    EXPECT_EQ(lines_of("JNTS", Buffer(15)), (Lines{"cut", "15 more"}));
}

TEST(LeafParts, NeverLieOutsideThePayload) {
    std::mt19937 random(1);
    for (const RecordLayout& layout : record_layouts()) {
        const LeafLayout* leaf = find_leaf(layout.chunk);
        ASSERT_NE(leaf, nullptr) << layout.name;
        for (int round = 0; round < 2'000; ++round) {
            Buffer payload(random() % 200);
            for (std::byte& byte : payload) {
                const auto drawn = random() % 4;
                byte = static_cast<std::byte>(drawn == 0   ? random()
                                              : drawn == 1 ? 0xffu
                                              : drawn == 2 ? 0u
                                                           : random() % 3);
            }
            const LocatedParts parts = locate_parts(*leaf, payload);
            std::uint64_t end = 0;
            for (const LocatedPart& part : parts.list) {
                EXPECT_GE(part.offset, end);
                end = part.offset + part.size;
                ASSERT_LE(end, payload.size());
            }
            ASSERT_LE(parts.end, payload.size());
            ASSERT_GE(parts.end, end);
        }
    }
}

TEST(LeafParts, SayWhatNumbersReferTo) {
    const RecordLayout& tracks = *find_layout("TrackRecord");
    Buffer track(sizeof(TrackRecord));
    EXPECT_EQ(referred_entity(tracks, *tracks.find("target"), track, 0), Entity::joint);
    track[offsetof(TrackRecord, path)] = std::byte{3};
    EXPECT_EQ(referred_entity(tracks, *tracks.find("target"), track, 0), Entity::mesh);
    track[offsetof(TrackRecord, path)] = std::byte{255};
    EXPECT_EQ(referred_entity(tracks, *tracks.find("target"), track, 0), Entity::nothing);
    EXPECT_EQ(tracks.find("interpolation")->value_name(2), "cubic");
    EXPECT_EQ(tracks.find("interpolation")->value_name(3), "");
    EXPECT_EQ(tracks.find("keys")->value_name(0), "");
    const RecordLayout& range = *find_layout("JointSubmesh");
    EXPECT_EQ(range.find("joint")->reference.entity, Entity::joint);
    EXPECT_EQ(range.find("mesh")->offset, 4u);
    EXPECT_TRUE(range.find("material")->reference.is_optional);
}

}  // namespace
}  // namespace bendy::leaf_parts_test
