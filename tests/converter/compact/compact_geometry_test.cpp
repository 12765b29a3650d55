#include "optimise/compact/compact_geometry.h"
#include "optimise/measure_error.h"
#include "scene/evaluate.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/converter/import.h>
#include <bendy/format/document.h>
#include <bendy/runtime.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>

namespace bendy::converter::compact_geometry_test {
namespace {

/// Two joints, a wavy grid that they bend, one clip that turns the second.
Scene bent_grid(float scale, std::uint32_t influences, unsigned seed) {
    std::mt19937 random(seed);
    const auto fraction = [&] { return static_cast<float>(random() % 10001) / 10000.0f; };
    Scene scene;
    scene.joints.resize(2);
    scene.joints[0].name = "root";
    scene.joints[1].name = "tip";
    scene.joints[1].parent = 0;
    scene.joints[1].rest.translation = {0, scale, 0};
    Mesh& mesh = scene.meshes.emplace_back();
    constexpr std::uint32_t kSide = 12;
    for (std::uint32_t y = 0; y < kSide; ++y) {
        for (std::uint32_t x = 0; x < kSide; ++x) {
            const float share = static_cast<float>(y) / (kSide - 1);
            mesh.positions.emplace_back(scale * static_cast<float>(x) / kSide, scale * 2.0f * share,
                                        scale * 0.1f * fraction());
            mesh.normals.emplace_back(0, 0, 1);
            for (std::uint32_t k = 0; k < influences; ++k) {
                mesh.bones.push_back(k % 2);
                mesh.weights.push_back(k == 0 ? 1.0f - share : (k == 1 ? share : 0.0f));
            }
        }
    }
    mesh.influences = influences;
    if (influences == 0) mesh.joint = 1;
    mesh.palette.joints = {0, 1};
    glm::mat4 down(1.0f);
    down[3] = {0, -scale, 0, 1};
    mesh.palette.inverse_bind = {glm::mat4(1.0f), down};
    if (influences == 0) mesh.palette = {};
    Submesh& submesh = mesh.submeshes.emplace_back();
    for (std::uint32_t y = 0; y + 1 < kSide; ++y) {
        for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
            const std::uint32_t a = y * kSide + x;
            for (const std::uint32_t i : {a, a + 1, a + kSide, a + kSide, a + 1, a + kSide + 1})
                submesh.indices.push_back(i);
        }
    }
    Clip& clip = scene.clips.emplace_back();
    Track& track = clip.tracks.emplace_back();
    track.path = TrackPath::rotation;
    track.target = 1;
    track.components = 4;
    track.times = {0.0f, 1.0f};
    track.values = {0, 0, 0, 1, 0.70710678f, 0, 0, 0.70710678f};
    return scene;
}

std::vector<std::byte> compact_file(Scene& scene, double bound, CompactGeometry& geometry) {
    geometry = compact_geometry(scene, bound, {});
    BuildOptions options;
    options.compact = true;
    options.geometry = &geometry;
    Report report;
    return build_chunks(scene, "test", report, options);
}

/// Positions of the skin in a pose that no key states, as the runtime has them.
std::vector<glm::vec3> skinned(const std::vector<std::byte>& bytes, float time) {
    const auto model = Model::from_memory(bytes);
    EXPECT_TRUE(model.has_value());
    Pose pose(*model);
    if (!model->clips().empty()) {
        EXPECT_TRUE(sample(pose, &model->clips()[0], time));
    }
    std::vector<glm::vec3> positions(model->vertex_count());
    EXPECT_TRUE(skin(pose, {.out = {.positions = positions}}));
    return positions;
}

/// Metres.
double measured(const Scene& exact, const Scene& scene, const CompactGeometry& geometry) {
    std::vector<std::vector<std::uint32_t>> maps;
    for (const CompactMesh& mesh : geometry.meshes) maps.push_back(mesh.vertex_of);
    return measure_error(exact, scene, {.vertex_maps = maps}).metres;
}

TEST(CompactGeometry, ThePosedSkinKeepsTheBoundAtEveryScale) {
    for (const float scale : {1e-3f, 1.0f, 100.0f}) {
        for (const std::uint32_t influences : {0u, 2u, 4u}) {
            for (const double share : {1e-2, 1e-3, 5e-5}) {
                const Scene exact = bent_grid(scale, influences, 3);
                Scene scene = exact;
                CompactGeometry geometry;
                const double bound = share * scale;
                const auto bytes = compact_file(scene, bound, geometry);
                ASSERT_TRUE(validate(bytes).empty());
                Report report;
                const auto source = build_chunks(exact, "test", report);
                EXPECT_LT(bytes.size(), source.size());
                EXPECT_EQ(geometry.meshes[0].bind_base.has_value(), influences != 0);
                EXPECT_LE(measured(exact, scene, geometry), bound);
                for (const float time : {0.0f, 0.37f, 1.0f}) {
                    const auto a = skinned(source, time);
                    const auto b = skinned(bytes, time);
                    double worst = 0.0;
                    for (std::size_t v = 0; v < a.size(); ++v) {
                        const glm::vec3 d = a[v] - b[geometry.meshes[0].vertex_of[v]];
                        worst = std::max(worst, std::sqrt(double{d.x} * d.x + double{d.y} * d.y + double{d.z} * d.z));
                    }
                    EXPECT_LE(worst, bound + 4e-7 * scale) << scale << ' ' << influences << ' ' << share << ' ' << time;
                }
            }
        }
    }
}

TEST(CompactGeometry, DirectionsAreTheSourcesWhenTheFileIsImported) {
    Scene exact = bent_grid(1.0f, 2, 5);
    Mesh& mesh = exact.meshes[0];
    for (std::size_t v = 0; v < mesh.normals.size(); ++v) {
        const float turn = 0.3f * static_cast<float>(v);
        mesh.normals[v] = {0.6f * std::cos(turn), 0.6f * std::sin(turn), v % 2 == 0 ? 0.8f : -0.8f};
        mesh.tangents.emplace_back(-std::sin(turn), std::cos(turn), 0.0f, v % 3 == 0 ? -1.0f : 1.0f);
    }
    Scene scene = exact;
    CompactGeometry geometry;
    const auto bytes = compact_file(scene, 1e-3, geometry);
    Report report;
    const auto imported = import_bendy(bytes, report);
    ASSERT_TRUE(imported) << imported.error().message;
    const Mesh& found = imported->meshes[0];
    ASSERT_EQ(found.normals.size(), found.positions.size());
    ASSERT_EQ(found.tangents.size(), found.positions.size());
    for (std::size_t v = 0; v < mesh.normals.size(); ++v) {
        const std::uint32_t place = geometry.meshes[0].vertex_of[v];
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(found.normals[place][c], mesh.normals[v][c], 0.02) << v;
            EXPECT_NEAR(found.tangents[place][c], mesh.tangents[v][c], 0.02) << v;
        }
        EXPECT_EQ(found.tangents[place].w, mesh.tangents[v].w) << v;
    }
}

TEST(CompactGeometry, TheJointTableSaysWhatTheChunksSaid) {
    const Scene exact = bent_grid(1.0f, 2, 3);
    Scene scene = exact;
    CompactGeometry geometry;
    const auto bytes = compact_file(scene, 1e-3, geometry);
    Report report;
    const auto source = build_chunks(exact, "test", report);
    const auto a = Model::from_memory(source);
    const auto b = Model::from_memory(bytes);
    ASSERT_TRUE(a && b);
    ASSERT_EQ(a->joints().size(), b->joints().size());
    for (std::size_t joint = 0; joint < a->joints().size(); ++joint) {
        EXPECT_EQ(a->joints()[joint].name, b->joints()[joint].name);
        EXPECT_EQ(a->joints()[joint].parent, b->joints()[joint].parent);
        EXPECT_EQ(a->joints()[joint].rest.translation, b->joints()[joint].rest.translation);
    }
    ASSERT_EQ(a->submeshes().size(), b->submeshes().size());
    EXPECT_EQ(a->submeshes()[0].count, b->submeshes()[0].count);
}

/// Every triangle by its corners' places in the source, turned to start with the smallest, sorted.
std::vector<std::array<std::uint32_t, 3>> triangles(const Mesh& mesh, const std::vector<std::uint32_t>& place) {
    std::vector<std::array<std::uint32_t, 3>> list;
    for (const Submesh& submesh : mesh.submeshes) {
        for (std::size_t at = 0; at + 3 <= submesh.indices.size(); at += 3) {
            std::array<std::uint32_t, 3> t{place[submesh.indices[at]], place[submesh.indices[at + 1]],
                                           place[submesh.indices[at + 2]]};
            std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
            list.push_back(t);
        }
    }
    std::sort(list.begin(), list.end());
    return list;
}

TEST(CompactGeometry, VerticesAlikeAreOneAndTrianglesStay) {
    Scene scene = bent_grid(1.0f, 2, 3);
    // Every triangle with corners of its own.
    Mesh& mesh = scene.meshes[0];
    Mesh loose = mesh;
    loose.positions.clear();
    loose.normals.clear();
    loose.bones.clear();
    loose.weights.clear();
    for (std::uint32_t k = 0; k < mesh.submeshes[0].indices.size(); ++k) {
        const std::uint32_t v = mesh.submeshes[0].indices[k];
        loose.positions.push_back(mesh.positions[v]);
        loose.normals.push_back(mesh.normals[v]);
        for (std::size_t i = 0; i < 2; ++i) {
            loose.bones.push_back(mesh.bones[v * 2 + i]);
            loose.weights.push_back(mesh.weights[v * 2 + i]);
        }
        loose.submeshes[0].indices[k] = k;
    }
    const std::size_t vertices = mesh.positions.size();
    mesh = loose;
    const Scene exact = scene;
    const CompactGeometry geometry = compact_geometry(scene, 1e-3, {});
    EXPECT_EQ(scene.meshes[0].positions.size(), vertices);
    std::vector<std::uint32_t> itself(vertices);
    for (std::uint32_t v = 0; v < vertices; ++v) itself[v] = v;
    EXPECT_EQ(triangles(exact.meshes[0], geometry.meshes[0].vertex_of), triangles(scene.meshes[0], itself));
}

TEST(CompactGeometry, VerticesThatMoveOtherwiseStayApart) {
    Scene scene = bent_grid(1.0f, 2, 3);
    Mesh& mesh = scene.meshes[0];
    mesh.positions.assign(mesh.positions.size(), glm::vec3(0, 1, 0));  // all in one place
    mesh.submeshes[0].indices.resize(3);
    std::vector<float> kinds;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        kinds.push_back(v % 3 == 0 ? 1.0f : 0.5f);
        mesh.weights[v * 2] = v % 3 == 0 ? 1.0f : 0.5f;
        mesh.weights[v * 2 + 1] = v % 3 == 0 ? 0.0f : 0.5f;
    }
    MorphTarget& target = mesh.targets.emplace_back();
    target.positions.resize(mesh.positions.size());
    target.positions[1] = {0, 0, 1};
    compact_geometry(scene, 1e-3, {});
    EXPECT_EQ(mesh.positions.size(), 3u);  // two kinds of weights, and one that a target moves
}

TEST(CompactGeometry, WhatCannotBeQuantisedStaysAsItIs) {
    Scene scene = bent_grid(1.0f, 2, 3);
    scene.meshes[0].normals[5] = {0, 3, 0};
    const Scene exact = scene;
    CompactGeometry geometry;
    const auto bytes = compact_file(scene, 1e-9, geometry);
    EXPECT_TRUE(validate(bytes).empty());
    EXPECT_FALSE(geometry.meshes[0].positions);
    EXPECT_FALSE(geometry.meshes[0].normals);
    EXPECT_LE(measured(exact, scene, geometry), 1e-9);
}

TEST(CompactGeometry, LinesPointsAndEmptyMeshes) {
    Scene scene = bent_grid(1.0f, 2, 3);
    scene.meshes[0].submeshes.push_back({Topology::lines, kNone, {0, 1, 1, 2}});
    scene.meshes[0].submeshes.push_back({Topology::points, kNone, {5, 6, 7}});
    scene.meshes.emplace_back();
    const Scene exact = scene;
    CompactGeometry geometry;
    const auto bytes = compact_file(scene, 1e-3, geometry);
    EXPECT_TRUE(validate(bytes).empty());
    EXPECT_EQ(skinned(bytes, 0.5f).size(), scene.meshes[0].positions.size());
}

TEST(CompactGeometry, TrianglesAtACrowdedVertexKeepTheirOrder) {
    // A cone of very many triangles beside a strip of few: what orders them would take the square of their number.
    constexpr std::uint32_t kCone = 2000;
    Mesh mesh;
    mesh.joint = 0;
    mesh.positions.resize(kCone + 6);
    for (std::uint32_t k = 0; k < mesh.positions.size(); ++k) mesh.positions[k] = {static_cast<float>(k), 0.0f, 1.0f};
    std::vector<std::uint32_t> indices{kCone + 3, kCone + 4, kCone + 5};
    for (std::uint32_t k = 0; k < kCone; ++k) indices.insert(indices.end(), {0, 1 + k, 1 + (k + 1) % kCone});
    mesh.submeshes.push_back({Topology::triangles, kNone, indices});
    CompactMesh compact;
    compact.vertex_of.resize(mesh.positions.size());
    std::iota(compact.vertex_of.begin(), compact.vertex_of.end(), 0u);
    order_for_codecs(mesh, compact, {});
    ASSERT_EQ(mesh.submeshes.size(), 1u);
    const std::vector<std::uint32_t>& after = mesh.submeshes[0].indices;
    ASSERT_EQ(after.size(), indices.size());
    for (std::size_t at = 0; at < after.size(); at += 3) {  // which corner is the first is the codec's matter
        std::vector<std::uint32_t> here(after.begin() + static_cast<std::ptrdiff_t>(at),
                                        after.begin() + static_cast<std::ptrdiff_t>(at) + 3);
        std::vector<std::uint32_t> there;
        for (std::size_t k = at; k < at + 3; ++k) there.push_back(compact.vertex_of[indices[k]]);
        std::sort(here.begin(), here.end());
        std::sort(there.begin(), there.end());
        ASSERT_EQ(here, there);
    }
}

TEST(CompactGeometry, TheSameSceneGivesTheSameBytes) {
    CompactGeometry geometry;
    Scene a = bent_grid(1.0f, 4, 3);
    Scene b = bent_grid(1.0f, 4, 3);
    EXPECT_EQ(compact_file(a, 1e-4, geometry), compact_file(b, 1e-4, geometry));
}

TEST(CompactGeometry, HeightIsThatOfTheSkinAtRest) {
    EXPECT_NEAR(height_at_rest(bent_grid(2.0f, 2, 3)), 4.0, 1e-6);
    EXPECT_EQ(height_at_rest(Scene()), 0.0);
}

}  // namespace
}  // namespace bendy::converter::compact_geometry_test
