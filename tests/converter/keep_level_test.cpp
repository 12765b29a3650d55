#include "optimise/passes/mesh_order.h"

#include "scene/failure.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace bendy::converter::keep_level_test {
namespace {

/// A strip of five vertices, 4 collapsing to 3, 3 to 1; a mesh without a sequence beside it.
Scene strip() {
    Scene scene;
    scene.joints.emplace_back();
    Mesh mesh;
    for (int v = 0; v < 5; ++v) mesh.positions.emplace_back(v, v % 2, 0.0f);
    mesh.normals.assign(5, {0.0f, 0.0f, 1.0f});
    mesh.texture_coords.push_back({"", 0, 2, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}});
    mesh.influences = 2;
    mesh.bones = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
    mesh.weights = {1, 0, 1, 0, 1, 0, 1, 0, 1, 0};
    mesh.targets.push_back({"blink", 0.0f, mesh.positions, {}, {}});
    // The third one has no area from the beginning.
    mesh.submeshes.push_back({Topology::triangles, kNone, {0, 1, 2, 2, 1, 3, 3, 3, 0, 2, 3, 4}});
    mesh.submeshes.push_back({Topology::lines, kNone, {0, 4, 3, 4}});
    mesh.collapse = {0, 1, 2, 1, 3};
    mesh.joined = {0, 0, 0, 0, 0};
    mesh.base = 3;
    Mesh whole = mesh;
    whole.collapse.clear();
    whole.joined.clear();
    whole.base = 0;
    scene.meshes = {mesh, whole};
    scene.levels = {{0.5f, {3, 5}}};
    return scene;
}

TEST(KeepLevel, TheOthersCollapseAndTrianglesWithoutAreaGo) {
    Scene scene = strip();
    keep_level(scene, std::array{3u, 5u});
    const Mesh& mesh = scene.meshes[0];
    EXPECT_EQ(mesh.positions.size(), 3u);
    EXPECT_EQ(mesh.normals.size(), 3u);
    EXPECT_EQ(mesh.texture_coords[0].values, (std::vector<float>{0, 1, 2, 3, 4, 5}));
    EXPECT_EQ(mesh.bones, (std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5}));
    EXPECT_EQ(mesh.weights.size(), 6u);
    EXPECT_EQ(mesh.targets[0].positions.size(), 3u);
    EXPECT_EQ(mesh.submeshes[0].indices, (std::vector<std::uint32_t>{0, 1, 2, 1, 1, 0}));
    EXPECT_EQ(mesh.submeshes[1].indices, (std::vector<std::uint32_t>{0, 1, 1, 1}));
    EXPECT_TRUE(mesh.collapse.empty());
    EXPECT_TRUE(mesh.joined.empty());
    EXPECT_EQ(mesh.base, 0u);
    EXPECT_EQ(scene.meshes[1].positions.size(), 5u);
    EXPECT_TRUE(scene.levels.empty());
}

TEST(KeepLevel, FullDetailIsAllOfItWithoutTheSequence) {
    Scene scene = strip();
    keep_level(scene, std::array{5u, 5u});
    EXPECT_EQ(scene.meshes[0].submeshes[0].indices, strip().meshes[0].submeshes[0].indices);
    EXPECT_TRUE(scene.meshes[0].collapse.empty());
}

TEST(KeepLevel, NumbersThatAreNoLevelAreRefused) {
    const auto refused = [](std::vector<std::uint32_t> vertices) {
        Scene scene = strip();
        try {
            keep_level(scene, vertices);
        } catch (const Failure& failure) {
            return failure.error.place + ": " + failure.error.message;
        }
        return std::string("kept");
    };
    EXPECT_EQ(refused({2, 5}), "meshes[0]: there is no level of detail with 2 vertices");
    EXPECT_EQ(refused({6, 5}), "meshes[0]: there is no level of detail with 6 vertices");
    EXPECT_EQ(refused({3, 4}), "meshes[1]: there is no level of detail with 4 vertices");
    EXPECT_EQ(refused({3}), ": the level of detail is one of another file");
    EXPECT_EQ(refused({3, 5}), "kept");
}

}  // namespace
}  // namespace bendy::converter::keep_level_test
