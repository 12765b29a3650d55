#include "optimise/passes/mesh_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>
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
    sort_by_bones(mesh);
    std::set<float> met;
    for (std::size_t vertex = 0; vertex < kVertices; ++vertex) {
        const float number = mesh.positions[vertex].x;
        met.insert(number);
        EXPECT_EQ(mesh.normals[vertex].y, -number);
        EXPECT_EQ(mesh.targets[0].positions[vertex].z, 2.0f * number);
        EXPECT_EQ(mesh.texture_coords[0].values[2 * vertex], number);
        EXPECT_EQ(mesh.texture_coords[0].values[2 * vertex + 1], 3.0f * number);
        const auto old = static_cast<std::size_t>(number);
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
    sort_by_bones(mesh);
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
    sort_by_bones(mesh);
    EXPECT_LT(2 * bones_of_groups(mesh), before);
}

TEST(SortByBones, RigidAndCollapsibleMeshesStay) {
    Mesh collapsible = numbered_mesh();
    collapsible.collapse.resize(kVertices);
    Mesh rigid = numbered_mesh();
    rigid.influences = 0;
    rigid.bones.clear();
    rigid.weights.clear();
    for (Mesh* mesh : {&collapsible, &rigid}) {
        const auto positions = mesh->positions;
        sort_by_bones(*mesh);
        EXPECT_EQ(mesh->positions, positions);
    }
}

}  // namespace
}  // namespace bendy::converter::sort_by_bones_test
