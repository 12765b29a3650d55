#include <bendy/format/lod.h>

#include "edit_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace bendy::test::lod_test {
namespace {

const std::string kPath = "HEAD/OBJE/LODD";

/// What is said of the sample with this LODD; mesh 0 has 4 vertices, mesh 1 has 6.
Lines faults_with(const Buffer& payload) {
    Node root = sample();
    at(root, kPath).payload = payload;
    return faults_in(root);
}
Lines faults_with(const std::function<void(CollapseRecord&)>& change) {
    Node root = sample();
    edit<CollapseRecord>(at(root, kPath), change);
    return faults_in(root);
}
Lines faults_with_mesh(const std::function<void(MeshCollapseRecord&)>& change) {
    Node root = sample();
    edit<MeshCollapseRecord>(at(root, kPath), change, sizeof(CollapseRecord));
    return faults_in(root);
}
Lines said(const std::string& code) {
    return {code + " " + kPath};
}

TEST(Lod, ReadsTheSample) {
    const Loaded loaded(sample());
    ASSERT_EQ(loaded.lines(), Lines{});
    const auto& collapse = loaded.document.objects[0].collapse;
    ASSERT_TRUE(collapse.has_value());
    ASSERT_EQ(collapse->meshes.size(), 1u);
    const MeshCollapseView& mesh = collapse->meshes[0];
    EXPECT_EQ(mesh.mesh, 0u);
    EXPECT_EQ(mesh.base, 3u);
    EXPECT_EQ(mesh.vertices, 4u);
    EXPECT_EQ(mesh.target(3), 1u);
    EXPECT_FALSE(mesh.is_joined(3));
    ASSERT_EQ(collapse->levels, 2u);
    EXPECT_EQ(collapse->error(0), 0.0f);
    EXPECT_EQ(collapse->alive(0, 0), 4u);
    EXPECT_EQ(collapse->error(1), 0.5f);
    EXPECT_EQ(collapse->alive(1, 0), 3u);
}

TEST(Lod, ReadsWideTargetsBitsAndNoLevels) {
    Node root = sample();
    at(root, kPath).payload = collapse_payload<std::uint32_t>(1, 1, {0, 0, 2, 1, 4}, {}, {0b10100});
    const Loaded loaded(root);
    ASSERT_EQ(loaded.lines(), Lines{});
    const CollapseView& collapse = *loaded.document.objects[0].collapse;
    EXPECT_EQ(collapse.levels, 0u);
    const MeshCollapseView& mesh = collapse.meshes[0];
    const std::vector<std::uint32_t> targets{0, 0, 2, 1, 4};
    const std::vector<bool> joined{false, false, true, false, true};
    for (std::uint32_t k = 0; k < 5; ++k) {
        EXPECT_EQ(mesh.target(1 + k), targets[k]);
        EXPECT_EQ(mesh.is_joined(1 + k), joined[k]);
    }
}

TEST(Lod, AFileWithoutHasNone) {
    Node root = sample();
    remove(at(root, "HEAD/OBJE"), "LODD");
    const Loaded loaded(root);
    EXPECT_EQ(loaded.lines(), Lines{});
    EXPECT_FALSE(loaded.document.objects[0].collapse.has_value());
}

TEST(Lod, RefusesTargetsThatAreNotBelowTheirVertex) {
    EXPECT_EQ(faults_with(collapse_payload<std::uint16_t>(0, 3, {3})), said("COLLAPSE_TARGET"));
    EXPECT_EQ(faults_with(collapse_payload<std::uint16_t>(0, 3, {65535})), said("COLLAPSE_TARGET"));
    EXPECT_EQ(faults_with(collapse_payload<std::uint16_t>(0, 2, {3, 2})), said("COLLAPSE_TARGET"));
    EXPECT_EQ(faults_with(collapse_payload<std::uint16_t>(0, 0, {0, 0, 0, 0})), said("COLLAPSE_TARGET"));
    EXPECT_EQ(faults_with(collapse_payload<std::uint32_t>(0, 3, {0xffff'ffff})), said("COLLAPSE_TARGET"));
    EXPECT_EQ(faults_with(collapse_payload<std::uint16_t>(0, 1, {0, 1, 2})), Lines{});
}

TEST(Lod, RefusesMeshesThatAreNotThereOrRepeated) {
    EXPECT_EQ(faults_with(collapse_payload<std::uint16_t>(2, 3, {1})), said("MESH_RANGE"));
    EXPECT_EQ(faults_with(collapse_payload<std::uint16_t>(kNone, 3, {1})), said("MESH_RANGE"));
    for (const std::uint32_t second : {0u, 1u}) {
        CollapseRecord record;
        record.meshes = 2;
        std::vector<MeshCollapseRecord> meshes(2);
        meshes[0].mesh = 1;
        meshes[0].base = 6;
        meshes[1].mesh = second;
        meshes[1].base = second == 1 ? 6 : 4;
        meshes[0].target_type = meshes[1].target_type = 2;
        Buffer payload;
        append_padded(payload, std::vector{record});
        append_padded(payload, meshes);
        EXPECT_EQ(faults_with(payload), said("COLLAPSE_MESH")) << second;
    }
}

TEST(Lod, TakesSeveralMeshesOfWhichNothingCollapses) {
    CollapseRecord record;
    record.meshes = 2;
    std::vector<MeshCollapseRecord> meshes(2);
    meshes[0].base = 4;
    meshes[1].mesh = 1;
    meshes[1].base = 6;
    meshes[0].target_type = meshes[1].target_type = 2;
    Node root = sample();
    Buffer& payload = at(root, kPath).payload;
    payload.clear();
    append_padded(payload, std::vector{record});
    append_padded(payload, meshes);
    const Loaded loaded(root);
    EXPECT_EQ(loaded.lines(), Lines{});
    const auto& collapse = loaded.document.objects[0].collapse;
    ASSERT_TRUE(collapse.has_value());
    ASSERT_EQ(collapse->meshes.size(), 2u);
    EXPECT_EQ(collapse->meshes[1].mesh, 1u);
    EXPECT_TRUE(collapse->meshes[1].targets.empty());
}

TEST(Lod, RefusesFieldsOutOfRange) {
    EXPECT_EQ(faults_with_mesh([](auto& mesh) { mesh.base = 5; }), said("INDEX_RANGE"));
    for (const int type : {0, 1, 3, 5, 6, 255}) {
        EXPECT_EQ(faults_with_mesh([=](auto& mesh) { mesh.target_type = static_cast<std::uint8_t>(type); }),
                  said("STREAM_TYPE"))
            << type;
    }
    for (std::size_t k = 0; k < 7; ++k)
        EXPECT_EQ(faults_with_mesh([=](auto& mesh) { mesh.reserved[k] = 1; }), said("RESERVED_FIELD"));
    for (std::size_t k = 0; k < 2; ++k)
        EXPECT_EQ(faults_with([=](CollapseRecord& record) { record.reserved[k] = 1; }), said("RESERVED_FIELD"));
}

TEST(Lod, RefusesCountsThatDoNotGoWithTheSize) {
    for (const std::uint32_t meshes : {0u, 2u, 4u, 5u, 6u, 0x1000'0000u, 0xffff'ffffu}) {
        const Lines lines = faults_with([=](CollapseRecord& record) { record.meshes = meshes; });
        EXPECT_FALSE(lines.empty()) << meshes;
    }
    for (const std::uint32_t levels : {0u, 3u, 4u, 8u, 9u, 0x2000'0000u, 0xffff'ffffu}) {
        const Lines lines = faults_with([=](CollapseRecord& record) { record.levels = levels; });
        EXPECT_FALSE(lines.empty()) << levels;
    }
    EXPECT_EQ(faults_with_mesh([](auto& mesh) { mesh.base = 4; }), said("RECORD_SIZE"));
    const Buffer good = collapse_payload<std::uint16_t>(0, 3, {1}, {{0.0f, 4}, {0.5f, 3}});
    ASSERT_EQ(faults_with(good), Lines{});
    for (std::size_t size = 0; size < good.size(); ++size)
        EXPECT_NE(faults_with(Buffer(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size))), Lines{}) << size;
    Buffer longer = good;
    longer.resize(longer.size() + 16);
    EXPECT_EQ(faults_with(longer), said("RECORD_SIZE"));
}

TEST(Lod, RefusesNumbersInGapsAndSpareBits) {
    const Buffer good = collapse_payload<std::uint16_t>(0, 3, {1}, {{0.0f, 4}});
    ASSERT_EQ(faults_with(good), Lines{});
    // levels at 32, targets at 48, bits at 64
    for (const std::size_t gap : {40u, 47u, 50u, 63u, 65u, 79u}) {
        Buffer payload = good;
        payload[gap] = std::byte{1};
        EXPECT_EQ(faults_with(payload), said("RESERVED_FIELD")) << gap;
    }
    for (const unsigned bits : {1u, 2u, 128u}) {
        Buffer payload = good;
        payload[64] = static_cast<std::byte>(bits);
        EXPECT_EQ(faults_with(payload), said("RESERVED_FIELD")) << bits;
    }
}

TEST(Lod, RefusesLevelsOutOfOrder) {
    const auto faults = [](const std::vector<std::pair<float, std::uint32_t>>& levels) {
        return faults_with(collapse_payload<std::uint16_t>(0, 3, {1}, levels));
    };
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    EXPECT_EQ(faults({{0.0f, 4}, {0.0f, 4}, {1.0f, 3}, {1.0f, 3}}), Lines{});
    EXPECT_EQ(faults({{0.0f, 5}}), said("COLLAPSE_LEVEL"));
    EXPECT_EQ(faults({{0.0f, 2}}), said("COLLAPSE_LEVEL"));
    EXPECT_EQ(faults({{0.0f, 3}, {0.5f, 4}}), said("COLLAPSE_LEVEL"));
    EXPECT_EQ(faults({{0.5f, 4}, {0.25f, 3}}), said("COLLAPSE_LEVEL"));
    EXPECT_EQ(faults({{-1.0f, 4}}), said("COLLAPSE_LEVEL"));
    EXPECT_EQ(faults({{kNan, 4}}), said("COLLAPSE_LEVEL"));
    EXPECT_EQ(faults({{kInfinity, 4}}), said("COLLAPSE_LEVEL"));
}

TEST(Lod, RefusesASecondOneAndAContainer) {
    Node root = sample();
    Node& object = at(root, "HEAD/OBJE");
    object.children.push_back(at(root, kPath));
    EXPECT_EQ(faults_in(root), Lines{"CHUNK_REPEATED HEAD/OBJE/LODD[1]"});
    Node other = sample();
    at(other, kPath) = make_container(FourCC("LODD"));
    EXPECT_EQ(faults_in(other), said("NOT_A_LEAF"));
}

}  // namespace
}  // namespace bendy::test::lod_test
