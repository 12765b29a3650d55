#include "optimise/collapse/collapse_vertices.h"
#include "optimise/passes/bone_order.h"
#include "source_folder.h"

#include <bendy/converter/import.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>
#include <span>
#include <tuple>
#include <vector>

namespace bendy::converter::sort_by_bones_test {
namespace {

constexpr std::uint32_t kVertices = 500;

/// Vertices whose every stream says which one it was; three influences of ten bones.
Mesh numbered_mesh() {
    Mesh mesh;
    mesh.influences = 3;
    mesh.palette.joints.resize(10);
    mesh.palette.inverse_bind.resize(10, glm::mat4(1.0f));
    std::mt19937 random(3);
    MorphTarget target;
    Stream coords;
    coords.components = 2;
    Submesh submesh;
    for (std::uint32_t vertex = 0; vertex < kVertices; ++vertex) {
        const auto number = static_cast<float>(vertex);
        mesh.positions.emplace_back(number);
        mesh.normals.emplace_back(-number);
        target.positions.emplace_back(2.0f * number);
        coords.values.insert(coords.values.end(), {number, 3.0f * number});
        const auto first = static_cast<std::uint32_t>(random() % 10);
        const auto second = static_cast<std::uint32_t>(random() % 10);
        const float half = vertex % 3 == 0 ? 0.0f : 0.5f;
        mesh.bones.insert(mesh.bones.end(), {first, second, 9});
        mesh.weights.insert(mesh.weights.end(), {1.0f - half, half, 0.0f});
        submesh.indices.push_back(static_cast<std::uint32_t>(random() % kVertices));
    }
    submesh.indices.resize(kVertices / 3 * 3);
    mesh.targets.push_back(target);
    mesh.texture_coords.push_back(coords);
    mesh.submeshes.push_back(submesh);
    return mesh;
}

void sort(Mesh& mesh) {
    Scene scene;
    scene.meshes.push_back(std::move(mesh));
    sort_by_bones(scene);
    mesh = std::move(scene.meshes[0]);
}

std::set<std::uint32_t> bones_of(const Mesh& mesh, std::size_t vertex) {
    std::set<std::uint32_t> bones;
    for (std::size_t k = vertex * mesh.influences; k < (vertex + 1) * mesh.influences; ++k) {
        if (mesh.weights[k] != 0.0f) bones.insert(mesh.bones[k]);
    }
    return bones;
}

/// Different bones that eight neighbours follow, over all groups of eight.
std::size_t bones_of_groups(const Mesh& mesh) {
    std::size_t sum = 0;
    for (std::size_t first = 0; first < mesh.positions.size(); first += 8) {
        std::set<std::uint32_t> bones;
        for (std::size_t vertex = first; vertex < std::min(first + 8, mesh.positions.size()); ++vertex)
            bones.merge(bones_of(mesh, vertex));
        sum += bones.size();
    }
    return sum;
}

TEST(SortByBones, StreamsTargetsAndIndicesStayTogether) {
    const Mesh before = numbered_mesh();
    Mesh mesh = before;
    sort(mesh);
    std::set<float> met;
    for (std::size_t vertex = 0; vertex < kVertices; ++vertex) {
        const float number = mesh.positions[vertex].x;
        met.insert(number);
        EXPECT_EQ(mesh.normals[vertex].y, -number);
        EXPECT_EQ(mesh.targets[0].positions[vertex].z, 2.0f * number);
        EXPECT_EQ(mesh.texture_coords[0].values[2 * vertex], number);
        EXPECT_EQ(mesh.texture_coords[0].values[2 * vertex + 1], 3.0f * number);
        const auto old = static_cast<std::size_t>(number);
        ASSERT_EQ(mesh.source_numbers.at(vertex), old);
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_EQ(mesh.bones[3 * vertex + k], before.bones[3 * old + k]);
            EXPECT_EQ(mesh.weights[3 * vertex + k], before.weights[3 * old + k]);
        }
    }
    EXPECT_EQ(met.size(), kVertices);
    ASSERT_EQ(mesh.submeshes[0].indices.size(), before.submeshes[0].indices.size());
    for (std::size_t k = 0; k < mesh.submeshes[0].indices.size(); ++k)
        EXPECT_EQ(mesh.positions[mesh.submeshes[0].indices[k]], before.positions[before.submeshes[0].indices[k]]);
}

TEST(SortByBones, WhatFollowsTheSameBonesLiesTogetherInItsOrder) {
    Mesh mesh = numbered_mesh();
    sort(mesh);
    std::set<std::set<std::uint32_t>> left;
    for (std::size_t vertex = 1; vertex < kVertices; ++vertex) {
        const auto bones = bones_of(mesh, vertex);
        if (bones == bones_of(mesh, vertex - 1)) {
            EXPECT_GT(mesh.positions[vertex].x, mesh.positions[vertex - 1].x);
        } else {
            EXPECT_TRUE(left.insert(bones_of(mesh, vertex - 1)).second);
            EXPECT_EQ(left.count(bones), 0u);
        }
    }
}

TEST(SortByBones, GroupsOfEightFollowFewerBones) {
    Mesh mesh = numbered_mesh();
    const std::size_t before = bones_of_groups(mesh);
    sort(mesh);
    EXPECT_LT(2 * bones_of_groups(mesh), before);
}

TEST(SortByBones, RigidMeshesStay) {
    Mesh mesh = numbered_mesh();
    mesh.influences = 0;
    mesh.bones.clear();
    mesh.weights.clear();
    const auto positions = mesh.positions;
    sort(mesh);
    EXPECT_EQ(mesh.positions, positions);
    EXPECT_TRUE(mesh.source_numbers.empty());
}

TEST(SortByBones, AMeshThatWouldGainLittleStays) {
    Mesh mesh = numbered_mesh();
    for (std::uint32_t vertex = 0; vertex < kVertices;
         ++vertex) {  // runs of 80, with a stray vertex in every fifth eight
        const std::uint32_t run = vertex / 80;
        for (std::uint32_t k = 0; k < 3; ++k) {
            mesh.bones[3 * vertex + k] = vertex % 80 == 40 ? 9 : run;
            mesh.weights[3 * vertex + k] = k == 0 ? 1.0f : 0.0f;
        }
    }
    const auto positions = mesh.positions;
    sort(mesh);
    EXPECT_EQ(mesh.positions, positions);
    EXPECT_TRUE(mesh.source_numbers.empty());
}

TEST(SortByBones, SortingAgainChangesNothing) {
    Mesh mesh = numbered_mesh();
    sort(mesh);
    const Mesh once = mesh;
    sort(mesh);
    EXPECT_EQ(mesh.positions, once.positions);
    EXPECT_EQ(mesh.source_numbers, once.source_numbers);
}

using Triangle = std::array<float, 9>;  // the places of its corners

/// Which vertex each one is with the first `alive` ones.
std::vector<std::uint32_t> vertices_at(const Mesh& mesh, std::uint32_t alive) {
    std::vector<std::uint32_t> now(mesh.positions.size());
    for (std::uint32_t vertex = 0; vertex < now.size(); ++vertex)
        now[vertex] = vertex < alive ? vertex : now[mesh.collapse[vertex]];
    return now;
}

/// The triangles with the first `alive` vertices, those without area left out.
/// \param before  if not empty, which vertex each one was: only triangles that have changed since
std::vector<Triangle> triangles_at(const Mesh& mesh, std::uint32_t alive, std::span<const std::uint32_t> before = {}) {
    const std::vector<std::uint32_t> now = vertices_at(mesh, alive);
    std::vector<Triangle> triangles;
    for (const Submesh& submesh : mesh.submeshes) {
        for (std::size_t k = 0; k + 2 < submesh.indices.size(); k += 3) {
            const std::uint32_t* corners = submesh.indices.data() + k;
            const std::array<std::uint32_t, 3> t{now[corners[0]], now[corners[1]], now[corners[2]]};
            if (!before.empty() && t[0] == before[corners[0]] && t[1] == before[corners[1]] &&
                t[2] == before[corners[2]])
                continue;
            if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
            Triangle places{};
            for (std::size_t c = 0; c < 9; ++c) places[c] = mesh.positions[t[c / 3]][static_cast<int>(c % 3)];
            triangles.push_back(places);
        }
    }
    return triangles;
}

std::vector<Triangle> sorted(std::vector<Triangle> triangles) {
    std::sort(triangles.begin(), triangles.end());
    return triangles;
}

/// The example with its levels, before and after sorting.
class SortedLevels : public testing::Test {
protected:
    static void SetUpTestSuite() {
        Report report;
        auto scene = import_gltf(source_folder() / "examples" / "mannequin.glb", {}, report);
        ASSERT_TRUE(scene.has_value());
        before = *std::move(scene);
        collapse_vertices(before);
        after = before;
        sort_by_bones(after);
    }

    static inline Scene before, after;
};

TEST_F(SortedLevels, HaveTheSameTriangles) {
    for (std::size_t m = 0; m < before.meshes.size(); ++m) {
        if (before.meshes[m].collapse.empty()) continue;
        EXPECT_TRUE(after.meshes[m].source_numbers.empty());
        EXPECT_EQ(after.meshes[m].base, before.meshes[m].base);
        for (const LodLevel& level : before.levels)
            ASSERT_EQ(sorted(triangles_at(after.meshes[m], level.alive[m])),
                      sorted(triangles_at(before.meshes[m], level.alive[m])));
    }
}

TEST_F(SortedLevels, FollowFewerBones) {
    std::size_t few = 0;
    std::size_t many = 0;
    for (std::size_t m = 0; m < before.meshes.size(); ++m) {
        few += bones_of_groups(after.meshes[m]);
        many += bones_of_groups(before.meshes[m]);
    }
    EXPECT_LT(few, 2 * many / 3);
}

// A triangle that no level has could be one that nobody measured: turned over, or far from the surface.
TEST_F(SortedLevels, HaveOnlyMeasuredTrianglesBetweenThem) {
    for (std::size_t m = 0; m < before.meshes.size(); ++m) {
        const Mesh& mesh = before.meshes[m];
        if (mesh.collapse.empty()) continue;
        std::set<Triangle> measured;
        std::vector<std::uint32_t> last;
        for (auto alive = mesh.base; alive <= mesh.positions.size(); ++alive) {
            if (alive < mesh.positions.size() && mesh.joined[alive] != 0) continue;
            const std::vector<Triangle> triangles = triangles_at(mesh, alive, last);
            measured.insert(triangles.begin(), triangles.end());
            last = vertices_at(mesh, alive);
        }
        for (auto alive = mesh.base; alive <= mesh.positions.size(); alive += 97) {
            if (alive < mesh.positions.size() && after.meshes[m].joined[alive] != 0) continue;
            for (const auto& triangle : triangles_at(after.meshes[m], alive)) ASSERT_TRUE(measured.contains(triangle));
        }
    }
}

TEST_F(SortedLevels, AreSortedOnce) {
    Scene again = after;
    sort_by_bones(again);
    for (std::size_t m = 0; m < after.meshes.size(); ++m) {
        EXPECT_EQ(again.meshes[m].positions, after.meshes[m].positions);
        EXPECT_EQ(again.meshes[m].collapse, after.meshes[m].collapse);
    }
}

}  // namespace
}  // namespace bendy::converter::sort_by_bones_test
