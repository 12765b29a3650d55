#include <bendy/format/bind_palette.h>
#include <bendy/format/codec.h>
#include <bendy/format/document.h>

#include "edit_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <limits>
#include <random>
#include <string>

namespace bendy::joint_table_test {
namespace {

using namespace test;

/// The sample, whose four joints say nothing themselves but in JNTS and JNAM.
Node with_table(std::uint32_t joints = 4, std::uint32_t ranges = 0, std::string_view names = {"a\0b\0\0d\0", 7}) {
    Node root = sample();
    Node& object = at(root, "HEAD/OBJE");
    for (const char* path :
         {"HEAD/OBJE/SKIN", "HEAD/OBJE/SKIN/SKIN", "HEAD/OBJE/SKIN/SKIN/SKIN", "HEAD/OBJE/SKIN/SKIN[1]"}) {
        remove(at(root, std::string(path) + "/PIVO"), "REST");
    }
    JointsRecord record;
    record.joints = joints;
    record.submeshes = ranges;
    Node table = make_leaf(FourCC("JNTS"), bytes_of(record));
    for (std::uint32_t joint = 0; joint < joints; ++joint) {
        RestRecord rest;
        rest.rotation = {0, 0, 0, 1};
        rest.translation = {static_cast<float>(joint), 0, 0};
        rest.scale = {1, 1, 1};
        const Bytes bytes = bytes_of(rest);
        table.payload.insert(table.payload.end(), bytes.begin(), bytes.end());
    }
    table.payload.resize(table.payload.size() + ranges * sizeof(JointSubmesh));
    object.children.push_back(table);
    object.children.push_back(make_leaf(FourCC("JNAM"), as_byte_span(names)));
    return root;
}

TEST(JointTable, SaysWhatTheJointsDoNot) {
    Node root = with_table();
    remove(at(root, "HEAD/OBJE/SKIN/SKIN"), "NAME");
    remove(at(root, "HEAD/OBJE/SKIN/SKIN/SKIN"), "PIVO");
    const Loaded loaded(root);
    EXPECT_EQ(loaded.lines(), Lines{});
    const auto& joints = loaded.document.objects[0].skeleton.joints;
    EXPECT_EQ(joints[0].name, "hip") << "its own name goes before";
    EXPECT_EQ(joints[1].name, "b");
    EXPECT_EQ(joints[3].rest.translation[0], 3.0f);
}

TEST(JointTable, ARestOfItsOwnGoesBefore) {
    Node root = with_table();
    RestRecord rest;
    rest.rotation = {0, 0, 0, 1};
    rest.translation = {9, 9, 9};
    rest.scale = {1, 1, 1};
    at(root, "HEAD/OBJE/SKIN/SKIN/PIVO").children.push_back(make_leaf(FourCC("REST"), bytes_of(rest)));
    const Loaded loaded(root);
    EXPECT_EQ(loaded.lines(), Lines{});
    EXPECT_EQ(loaded.document.objects[0].skeleton.joints[1].rest.translation[0], 9.0f);
}

TEST(JointTable, WithoutItEveryJointNeedsItsRest) {
    Node root = with_table();
    remove(at(root, "HEAD/OBJE"), "JNTS");
    EXPECT_EQ(faults_in(root).size(), 4u);
    EXPECT_EQ(faults_in(root)[0], "CHUNK_MISSING HEAD/OBJE/SKIN/PIVO");
    root = sample();
    remove(at(root, "HEAD/OBJE/SKIN/SKIN/SKIN"), "PIVO");
    EXPECT_EQ(faults_in(root), Lines{"CHUNK_MISSING HEAD/OBJE/SKIN/SKIN/SKIN"});
}

TEST(JointTable, IsHeldAgainstTheSkeleton) {
    EXPECT_EQ(faults_in(with_table(3))[0], "COUNT_MISMATCH HEAD/OBJE/JNTS");
    EXPECT_EQ(faults_in(with_table(5))[0], "COUNT_MISMATCH HEAD/OBJE/JNTS");
    Node root = with_table();
    at(root, "HEAD/OBJE/JNTS").payload.pop_back();
    EXPECT_EQ(faults_in(root)[0], "RECORD_SIZE HEAD/OBJE/JNTS");
    root = with_table();
    set(at(root, "HEAD/OBJE/JNTS"), offsetof(JointsRecord, submeshes), 0xffffffffu);
    EXPECT_EQ(faults_in(root)[0], "RECORD_SIZE HEAD/OBJE/JNTS");
    root = with_table(4, 1);
    const std::size_t range = sizeof(JointsRecord) + 4 * sizeof(RestRecord);
    set(at(root, "HEAD/OBJE/JNTS"), range, 4u);
    EXPECT_EQ(faults_in(root)[0], "JOINT_RANGE HEAD/OBJE/JNTS");
    set(at(root, "HEAD/OBJE/JNTS"), range, 1u);
    set(at(root, "HEAD/OBJE/JNTS"), range + 4, 2u);  // mesh
    EXPECT_EQ(faults_in(root)[0], "MESH_RANGE HEAD/OBJE/JNTS");
}

TEST(JointTable, AsManyNamesAsJoints) {
    using namespace std::string_view_literals;
    for (const std::string_view names : {""sv, "a\0b\0c\0"sv, "a\0b\0c\0d"sv, "a\0b\0c\0d\0e\0"sv})
        EXPECT_EQ(faults_in(with_table(4, 0, names)), Lines{"COUNT_MISMATCH HEAD/OBJE/JNAM"});
    EXPECT_EQ(faults_in(with_table(4, 0, "a\0\xff\0c\0d\0"sv))[0], "NOT_UTF8 HEAD/OBJE/JNAM");
}

TEST(JointTable, InverseBindMatricesFollowFromTheRestPose) {
    Node root = sample();
    Node& palette = at(root, "HEAD/OBJE/VECT/PALT");
    const std::size_t matrices = sizeof(PaletteRecord) + 16;
    palette.payload.resize(matrices + sizeof(glm::mat4));
    set(palette, offsetof(PaletteRecord, derived), 1u);
    glm::mat4 base(1.0f);
    base[3] = {1, 2, 3, 1};
    set(palette, matrices, base);
    const Loaded loaded(root);
    EXPECT_EQ(loaded.lines(), Lines{});
    const ObjectView& object = loaded.document.objects[0];
    const PaletteView& view = object.meshes[0].palette;
    ASSERT_EQ(view.inverse_bind().size(), view.joints.size());
    std::vector<RestRecord> rests;
    std::vector<std::uint32_t> parents;
    for (const JointView& joint : object.skeleton.joints) {
        rests.push_back(joint.rest);
        parents.push_back(joint.parent);
    }
    const auto rest = rest_matrices(rests, parents);
    for (std::size_t entry = 0; entry < view.joints.size(); ++entry) {
        const glm::dmat4 product = rest[view.joints[entry]] * glm::dmat4(view.inverse_bind()[entry]);
        for (int c = 0; c < 4; ++c) {
            for (int r = 0; r < 4; ++r) EXPECT_NEAR(product[c][r], base[c][r], 1e-5) << entry;
        }
    }
    set(palette, offsetof(PaletteRecord, derived), 2u);
    EXPECT_EQ(faults_in(root)[0], "ENUM_RANGE HEAD/OBJE/VECT/PALT");
}

TEST(JointTable, EveryMeshOfAnObjectMayDeriveItsMatrices) {
    Node root = sample();
    Node& palette = at(root, "HEAD/OBJE/VECT/PALT");
    const std::size_t matrices = sizeof(PaletteRecord) + 16;
    palette.payload.resize(matrices + sizeof(glm::mat4));
    set(palette, offsetof(PaletteRecord, derived), 1u);
    set(palette, matrices, glm::mat4(1.0f));
    Node& object = at(root, "HEAD/OBJE");
    object.children.push_back(Node(child(object, "VECT")));
    const Loaded loaded(root);
    EXPECT_EQ(loaded.lines(), Lines{});
    const auto& meshes = loaded.document.objects[0].meshes;
    ASSERT_EQ(meshes.size(), 3u);
    const auto first = meshes[0].palette.inverse_bind();
    const auto last = meshes[2].palette.inverse_bind();
    ASSERT_FALSE(first.empty());
    EXPECT_TRUE(std::equal(first.begin(), first.end(), last.begin(), last.end()));
}

/// A palette whose matrices follow, with more entries than its bytes: encoded.
Node encoded_palette(std::size_t entries) {
    std::mt19937 random(5);
    Buffer payload(sizeof(PaletteRecord) + padded(entries * sizeof(std::uint32_t)) + sizeof(glm::mat4));
    const PaletteRecord record{static_cast<std::uint32_t>(entries), 1, {}};
    std::memcpy(payload.data(), &record, sizeof record);
    for (std::size_t entry = 0; entry < entries; ++entry)
        payload[sizeof record + entry * sizeof(std::uint32_t)] = std::byte{static_cast<std::uint8_t>(random() & 1u)};
    return make_leaf(FourCC("PALT"), *encode_payload(Codec::zstd, payload, 0, 0),
                     static_cast<std::uint16_t>(static_cast<unsigned>(Codec::zstd) << 8U));
}

TEST(JointTable, DerivedMatricesOfAllObjectsHaveOneLimit) {
    Node root = sample();
    for (int copy = 0; copy < 2; ++copy) root.children.push_back(Node(child(root, "OBJE")));
    const std::size_t entries = to_file(root).size() * 12 / 5;
    at(root, "HEAD/OBJE/VECT/PALT") = encoded_palette(entries);
    const std::size_t most = to_file(root).size() * 2;  // matrices of 64 bytes in 128 times the file
    ASSERT_LT(entries, most);
    const auto is_ratio = [](const std::string& line) { return line.starts_with("CODEC_RATIO"); };
    const Lines one = faults_in(root);
    EXPECT_EQ(std::count_if(one.begin(), one.end(), is_ratio), 0);
    at(root, "HEAD/OBJE[1]/VECT/PALT") = encoded_palette(entries);
    ASSERT_GT(2 * entries, to_file(root).size() * 2);
    const Lines two = faults_in(root);
    EXPECT_EQ(std::count(two.begin(), two.end(), "CODEC_RATIO HEAD/OBJE[1]/VECT/PALT"), 1);
    at(root, "HEAD/OBJE[2]/VECT/PALT") = encoded_palette(entries);
    const Lines three = faults_in(root);
    EXPECT_EQ(std::count_if(three.begin(), three.end(), is_ratio), 1) << "it is said once";
}

TEST(Bound, IsReadAndFinite) {
    Node root = sample();
    EXPECT_FALSE(Loaded(root).document.bound);
    root.children.push_back(make_leaf(FourCC("BNDS"), bytes_of(BoundRecord{1e-4f, 5e-5f, 2.0f})));
    const Loaded loaded(root);
    ASSERT_TRUE(loaded.document.bound);
    EXPECT_EQ(loaded.document.bound->height, 2.0f);
    set(at(root, "HEAD/BNDS"), offsetof(BoundRecord, max_error), std::numeric_limits<float>::infinity());
    EXPECT_EQ(faults_in(root), Lines{"NOT_FINITE HEAD/BNDS"});
}

}  // namespace
}  // namespace bendy::joint_table_test
