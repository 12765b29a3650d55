#include "optimise/passes/mesh_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <tuple>
#include <vector>

namespace bendy::converter::assign_polygons_test {
namespace {

using Indices = std::vector<std::uint32_t>;

/// A mesh of `vertices` vertices with `influences` bones each; entry i of the palette is joint `joints[i]`.
Mesh skinned_mesh(std::uint32_t vertices, std::uint32_t influences, Indices joints, Indices bones,
                  std::vector<float> weights) {
    Mesh mesh;
    mesh.positions.resize(vertices);
    mesh.influences = influences;
    mesh.bones = std::move(bones);
    mesh.weights = std::move(weights);
    mesh.palette.joints = std::move(joints);
    mesh.palette.inverse_bind.resize(mesh.palette.joints.size(), glm::mat4(1.0f));
    return mesh;
}

Submesh triangles(Indices indices, std::uint32_t material = kNone) {
    return {Topology::triangles, material, std::move(indices)};
}

std::vector<std::uint32_t> joints_of(const AssignedPolygons& assigned) {
    std::vector<std::uint32_t> joints;
    for (const AssignedSubmesh& range : assigned.ranges) joints.push_back(range.joint);
    return joints;
}

/// The ranges follow one another from 0 to the end, none empty, none of part of a polygon.
void expect_cover(const AssignedPolygons& assigned) {
    std::uint32_t at = 0;
    for (const AssignedSubmesh& range : assigned.ranges) {
        EXPECT_EQ(range.first, at);
        EXPECT_GT(range.count, 0u);
        EXPECT_EQ(range.count % corners(range.topology), 0u);
        at += range.count;
    }
    EXPECT_EQ(at, assigned.indices.size());
}

TEST(AssignPolygons, TheHeaviestJointGetsTheTriangle) {
    // Corner by corner joint 7 leads; over all corners it is joint 4: 0.4 + 0.9 + 0.4 = 1.7 of 3.
    Mesh mesh = skinned_mesh(3, 2, {7, 4}, {0, 1, 0, 1, 0, 1}, {0.6f, 0.4f, 0.1f, 0.9f, 0.6f, 0.4f});
    mesh.submeshes = {triangles({0, 1, 2})};
    const AssignedPolygons assigned = assign_polygons(mesh);
    ASSERT_EQ(assigned.ranges.size(), 1u);
    EXPECT_EQ(assigned.ranges[0].joint, 4u);
    EXPECT_EQ(assigned.ranges[0].count, 3u);
    EXPECT_EQ(assigned.indices, (Indices{0, 1, 2}));
}

TEST(AssignPolygons, ATieGoesToTheSmallerJoint) {
    for (const Indices& palette : {Indices{9, 2}, Indices{2, 9}}) {
        Mesh mesh = skinned_mesh(3, 2, palette, {0, 1, 0, 1, 0, 1}, {0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f});
        mesh.submeshes = {triangles({0, 1, 2})};
        EXPECT_EQ(joints_of(assign_polygons(mesh)), (Indices{2}));
    }
}

TEST(AssignPolygons, PaletteEntriesOfOneJointCountTogether) {
    // Entries 0 and 1 are both joint 5: 0.3 + 0.3 against 0.4 of joint 1.
    Mesh mesh = skinned_mesh(3, 3, {5, 5, 1}, {0, 1, 2, 0, 1, 2, 0, 1, 2},
                             {0.3f, 0.3f, 0.4f, 0.3f, 0.3f, 0.4f, 0.3f, 0.3f, 0.4f});
    mesh.submeshes = {triangles({0, 1, 2})};
    EXPECT_EQ(joints_of(assign_polygons(mesh)), (Indices{5}));
}

TEST(AssignPolygons, ABoneWithoutWeightCountsForNothing) {
    // Joint 0 stands in every vertex, as padding.
    Mesh mesh = skinned_mesh(3, 2, {0, 3}, {1, 0, 1, 0, 1, 0}, {1, 0, 1, 0, 1, 0});
    mesh.submeshes = {triangles({0, 1, 2})};
    EXPECT_EQ(joints_of(assign_polygons(mesh)), (Indices{3}));
}

TEST(AssignPolygons, WithoutAnyWeightTheMeshsOwnJointGetsIt) {
    Mesh mesh = skinned_mesh(3, 1, {4}, {0, 0, 0}, {0, 0, 0});
    mesh.joint = 6;
    mesh.submeshes = {triangles({0, 1, 2})};
    EXPECT_EQ(joints_of(assign_polygons(mesh)), (Indices{6}));
}

TEST(AssignPolygons, ARigidMeshIsItsJoints) {
    Mesh mesh;
    mesh.positions.resize(4);
    mesh.joint = 2;
    mesh.submeshes = {triangles({0, 1, 2, 3, 2, 1})};
    const AssignedPolygons assigned = assign_polygons(mesh);
    EXPECT_EQ(joints_of(assigned), (Indices{2}));
    EXPECT_EQ(assigned.indices, (Indices{0, 1, 2, 3, 2, 1}));
    expect_cover(assigned);
}

TEST(AssignPolygons, MaterialThenTopologyThenJoint) {
    // Vertex v has all its weight on joint v.
    Mesh mesh = skinned_mesh(4, 1, {0, 1, 2, 3}, {0, 1, 2, 3}, {1, 1, 1, 1});
    mesh.submeshes = {
        triangles({3, 3, 3}, kNone), {Topology::points, 1, {2, 0}},      triangles({2, 2, 2, 0, 0, 0}, 1),
        triangles({1, 1, 1}, 0),     {Topology::lines, 0, {3, 3, 1, 1}}, triangles({0, 0, 0, 1, 1, 1}, 0),
    };
    const AssignedPolygons assigned = assign_polygons(mesh);
    expect_cover(assigned);
    using Line = std::tuple<std::uint32_t, Topology, std::uint32_t, std::uint32_t>;  // material, topology, joint, count
    std::vector<Line> lines;
    for (const AssignedSubmesh& range : assigned.ranges)
        lines.emplace_back(range.material, range.topology, range.joint, range.count);
    const std::vector<Line> expected{
        {0, Topology::triangles, 0, 3}, {0, Topology::triangles, 1, 6}, {0, Topology::lines, 1, 2},
        {0, Topology::lines, 3, 2},     {1, Topology::triangles, 0, 3}, {1, Topology::triangles, 2, 3},
        {1, Topology::points, 0, 1},    {1, Topology::points, 2, 1},    {kNone, Topology::triangles, 3, 3},
    };
    EXPECT_EQ(lines, expected);
}

TEST(AssignPolygons, TheSourcesOrderAndWindingStay) {
    Mesh mesh = skinned_mesh(6, 1, {0}, {0, 0, 0, 0, 0, 0}, {1, 1, 1, 1, 1, 1});
    mesh.submeshes = {triangles({4, 2, 0, 5, 5, 1}, 3), triangles({1, 0, 2}, 3)};
    const AssignedPolygons assigned = assign_polygons(mesh);
    EXPECT_EQ(assigned.indices, (Indices{4, 2, 0, 5, 5, 1, 1, 0, 2}));
    EXPECT_EQ(assigned.ranges.size(), 1u);
}

TEST(AssignPolygons, ManyPolygonsOfAJointKeepTheirOrder) {
    constexpr std::uint32_t kVertices = 300;
    Indices bones;
    for (std::uint32_t vertex = 0; vertex < kVertices; ++vertex) bones.push_back(vertex * 7 % 3);
    Mesh mesh = skinned_mesh(kVertices, 1, {0, 1, 2}, bones, std::vector<float>(kVertices, 1.0f));
    mesh.submeshes = {{Topology::points, 0, {}}};
    for (std::uint32_t vertex = 0; vertex < kVertices; ++vertex) mesh.submeshes[0].indices.push_back(vertex);
    const AssignedPolygons assigned = assign_polygons(mesh);
    ASSERT_EQ(joints_of(assigned), (Indices{0, 1, 2}));
    for (const AssignedSubmesh& range : assigned.ranges) {
        const auto begin = assigned.indices.begin() + range.first;
        EXPECT_TRUE(std::is_sorted(begin, begin + range.count)) << range.joint;
    }
}

TEST(AssignPolygons, NoPolygonsNoRanges) {
    Mesh mesh;
    EXPECT_TRUE(assign_polygons(mesh).ranges.empty());
    mesh.submeshes = {triangles({}), {Topology::points, 0, {}}};
    EXPECT_TRUE(assign_polygons(mesh).ranges.empty());
    EXPECT_TRUE(assign_polygons(mesh).indices.empty());
}

TEST(AssignPolygons, EveryPolygonComesOutOnce) {
    std::mt19937 random(3);
    constexpr std::uint32_t kVertices = 50;
    Mesh mesh = skinned_mesh(kVertices, 2, {3, 0, 8}, {}, {});
    for (std::uint32_t vertex = 0; vertex < kVertices; ++vertex) {
        const auto share = static_cast<float>(random() % 5) / 4.0f;
        mesh.bones.insert(mesh.bones.end(),
                          {static_cast<std::uint32_t>(random() % 3), static_cast<std::uint32_t>(random() % 3)});
        mesh.weights.insert(mesh.weights.end(), {share, 1.0f - share});
    }
    using Polygon = std::tuple<std::uint32_t, Topology, Indices>;
    std::vector<Polygon> given;
    for (std::uint32_t number = 0; number < 9; ++number) {
        Submesh submesh;
        submesh.topology = static_cast<Topology>(number % 3);
        submesh.material = number % 2 == 0 ? number : kNone;
        for (int polygon = 0; polygon < 40; ++polygon) {
            Indices polygon_corners;
            for (std::uint32_t c = 0; c < corners(submesh.topology); ++c)
                polygon_corners.push_back(static_cast<std::uint32_t>(random() % kVertices));
            submesh.indices.insert(submesh.indices.end(), polygon_corners.begin(), polygon_corners.end());
            given.emplace_back(submesh.material, submesh.topology, polygon_corners);
        }
        mesh.submeshes.push_back(submesh);
    }
    const AssignedPolygons assigned = assign_polygons(mesh);
    expect_cover(assigned);
    std::vector<Polygon> taken;
    for (const AssignedSubmesh& range : assigned.ranges) {
        for (std::uint32_t at = range.first; at < range.first + range.count; at += corners(range.topology)) {
            const auto begin = assigned.indices.begin() + at;
            taken.emplace_back(range.material, range.topology, Indices(begin, begin + corners(range.topology)));

            std::map<std::uint32_t, double> shares;
            for (const std::uint32_t vertex : std::get<2>(taken.back())) {
                for (std::uint32_t k = 0; k < 2; ++k)
                    shares[mesh.palette.joints[mesh.bones[2 * vertex + k]]] += mesh.weights[2 * vertex + k];
            }
            const auto heaviest = std::max_element(shares.begin(), shares.end(),
                                                   [](const auto& a, const auto& b) { return a.second < b.second; });
            EXPECT_EQ(range.joint,
                      heaviest->first);  // the quarters add up exactly; the first of equals has the smallest joint
        }
    }
    std::sort(given.begin(), given.end());
    std::sort(taken.begin(), taken.end());
    EXPECT_EQ(taken, given);
}

}  // namespace
}  // namespace bendy::converter::assign_polygons_test
