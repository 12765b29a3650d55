#include <bendy/converter/compare_characters.h>

#include "converter/posed_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace bendy::converter::compare_characters_test {
namespace {

using Kind = CharacterDifference::Kind;

constexpr ErrorBound kMillimetre{1e-3, false};

/// A random scene of which everything is drawn, with names and two materials.
Scene drawn_scene() {
    Scene scene = test::random_scene(7);
    for (std::size_t number = 0; number < scene.joints.size(); ++number)
        scene.joints[number].name = "joint " + std::to_string(number);
    scene.materials.resize(2);
    scene.materials[0].name = "skin";
    scene.materials[1].name = "hair";
    scene.meshes[0].name = "body";
    scene.meshes[1].name = "hat";
    scene.clips[0].name = "walk";
    scene.clips[1].name = "run";
    std::vector<std::uint32_t> all(scene.meshes[0].positions.size());
    std::iota(all.begin(), all.end(), 0u);
    const auto middle = all.begin() + 30;
    scene.meshes[0].submeshes = {{Topology::triangles, 0, {all.begin(), middle}},
                                 {Topology::triangles, 1, {middle, all.end() - 3}},
                                 {Topology::lines, 1, {57, 58}},
                                 {Topology::points, 0, {59}}};
    return scene;
}

/// Vertex v is where order[v] was.
void reorder(Mesh& mesh, const std::vector<std::uint32_t>& order) {
    const Mesh before = mesh;
    for (std::size_t v = 0; v < order.size(); ++v) {
        mesh.positions[v] = before.positions[order[v]];
        for (std::size_t k = 0; k < mesh.influences; ++k) {
            mesh.bones[v * mesh.influences + k] = before.bones[order[v] * mesh.influences + k];
            mesh.weights[v * mesh.influences + k] = before.weights[order[v] * mesh.influences + k];
        }
        for (std::size_t t = 0; t < mesh.targets.size(); ++t)
            mesh.targets[t].positions[v] = before.targets[t].positions[order[v]];
    }
    std::vector<std::uint32_t> number(order.size());
    for (std::uint32_t v = 0; v < order.size(); ++v) number[order[v]] = v;
    for (Submesh& submesh : mesh.submeshes) {
        for (std::uint32_t& index : submesh.indices) index = number[index];
    }
}

std::vector<std::string> places_of(const CharacterComparison& comparison) {
    std::vector<std::string> places;
    for (const CharacterDifference& difference : comparison.differences) places.push_back(difference.place);
    return places;
}

bool has(const CharacterComparison& comparison, const std::string& text) {
    return std::any_of(comparison.differences.begin(), comparison.differences.end(),
                       [&](const CharacterDifference& d) { return d.place.find(text) != std::string::npos; });
}

TEST(CompareCharacters, AnotherOrderIsTheSame) {
    const Scene a = drawn_scene();
    Scene b = a;
    std::vector<std::uint32_t> order(60);
    for (std::uint32_t v = 0; v < 60; ++v) order[v] = (v * 37 + 11) % 60;
    reorder(b.meshes[0], order);
    for (Submesh& submesh : b.meshes[0].submeshes) {
        if (submesh.topology != Topology::triangles) continue;
        std::rotate(submesh.indices.begin(), submesh.indices.begin() + 6, submesh.indices.end());
        for (std::size_t at = 0; at < submesh.indices.size(); at += 3)
            std::rotate(submesh.indices.begin() + static_cast<std::ptrdiff_t>(at),
                        submesh.indices.begin() + static_cast<std::ptrdiff_t>(at) + 1,
                        submesh.indices.begin() + static_cast<std::ptrdiff_t>(at) + 3);
    }
    std::swap(b.meshes[0].submeshes[2].indices[0], b.meshes[0].submeshes[2].indices[1]);
    std::swap(b.meshes[0], b.meshes[1]);
    for (Clip& clip : b.clips) {
        for (Track& track : clip.tracks) {
            if (track.path == TrackPath::weights) track.target = 1;
        }
    }
    std::swap(b.clips[0], b.clips[1]);
    std::swap(b.materials[0], b.materials[1]);
    for (Mesh& mesh : b.meshes) {
        for (Submesh& submesh : mesh.submeshes)
            submesh.material = submesh.material == kNone ? kNone : 1 - submesh.material;
    }
    for (const bool swaps : {false, true}) {
        const CharacterComparison comparison = compare_characters(swaps ? b : a, swaps ? a : b, {1e-6, false});
        EXPECT_EQ(places_of(comparison), std::vector<std::string>());
        EXPECT_EQ(comparison.worst, 0.0);
    }
}

TEST(CompareCharacters, AMovedVertexIsNamed) {
    const Scene a = drawn_scene();
    Scene b = a;
    b.meshes[0].positions[17].y += 0.05f;
    const CharacterComparison comparison = compare_characters(a, b, kMillimetre);
    ASSERT_FALSE(comparison.differences.empty());
    EXPECT_TRUE(std::all_of(comparison.differences.begin(), comparison.differences.end(),
                            [](const CharacterDifference& d) { return d.kind == Kind::distance; }));
    EXPECT_TRUE(has(comparison, "mesh \"body\", vertex 17, at rest"));
    EXPECT_GT(comparison.worst, 0.01);
    EXPECT_TRUE(compare_characters(a, b, {1.01 * *comparison.worst, false}).differences.empty());
    EXPECT_FALSE(compare_characters(a, b, {0.99 * *comparison.worst, false}).differences.empty());
}

TEST(CompareCharacters, AMovedJointIsNamed) {
    const Scene a = drawn_scene();
    Scene b = a;
    b.joints[6].rest.translation.x += 0.02f;
    const CharacterComparison comparison = compare_characters(a, b, kMillimetre);
    EXPECT_TRUE(has(comparison, "joint \"joint 6\", at rest"));
    EXPECT_FALSE(has(comparison, "joint \"joint 5\""));
    EXPECT_FALSE(has(comparison, "joint \"joint 7\""));
}

TEST(CompareCharacters, ATurnedJointIsNamed) {
    const Scene a = drawn_scene();
    Scene b = a;
    b.joints[7].rest.rotation = glm::vec4(0.0f, 0.0f, 0.0f, 1.0f);
    EXPECT_TRUE(has(compare_characters(a, b, kMillimetre), "joint \"joint 7\", at rest"));
}

TEST(CompareCharacters, AnotherKeyIsNamedByItsClip) {
    const Scene a = drawn_scene();
    Scene b = a;
    const auto moves = [](const Track& track) {
        return track.path == TrackPath::translation && track.interpolation == Interpolation::linear;
    };
    const auto track = std::find_if(b.clips[1].tracks.begin(), b.clips[1].tracks.end(), moves);
    ASSERT_NE(track, b.clips[1].tracks.end());
    track->values[0] += 0.1f;
    const CharacterComparison comparison = compare_characters(a, b, kMillimetre);
    EXPECT_TRUE(has(comparison, "clip \"run\" at "));
    EXPECT_FALSE(has(comparison, "clip \"walk\""));
    EXPECT_FALSE(has(comparison, "at rest"));
}

TEST(CompareCharacters, ATargetIsNamed) {
    const Scene a = drawn_scene();
    Scene b = a;
    b.clips.clear();
    Scene still = a;
    still.clips.clear();
    b.meshes[0].targets[1].positions[5].z += 0.1f;
    EXPECT_TRUE(has(compare_characters(still, b, kMillimetre), "with target #1"));
}

TEST(CompareCharacters, FramesAreTheSameAsTargetsThatMoveSo) {
    Scene targets = drawn_scene();
    Mesh& moved = targets.meshes[0];
    for (MorphTarget& target : moved.targets) target.rest_weight = 0.0f;
    const auto count = static_cast<std::uint32_t>(moved.targets.size());
    ASSERT_GE(count, 2u);
    targets.clips.resize(1);
    std::erase_if(targets.clips[0].tracks, [](const Track& track) { return track.path == TrackPath::weights; });
    Scene frames = targets;
    Track weights;
    weights.path = TrackPath::weights;
    weights.target = 0;
    weights.components = count;
    for (std::uint32_t frame = 0; frame <= count; ++frame) {
        weights.times.push_back(static_cast<float>(frame) / 4.0f);
        for (std::uint32_t target = 0; target < count; ++target)
            weights.values.push_back(target + 1 == frame ? 1.0f : 0.0f);
    }
    targets.clips[0].tracks.push_back(weights);
    for (MorphTarget& target : frames.meshes[0].targets) {
        target.is_frame = true;
        for (std::size_t vertex = 0; vertex < target.positions.size(); ++vertex)
            target.positions[vertex] += frames.meshes[0].positions[vertex];
    }
    frames.clips[0].frame_rate = 4.0f;
    frames.clips[0].plays.push_back({0, 0, count + 1, false});
    for (const auto& [a, b] : {std::pair(&frames, &targets), std::pair(&targets, &frames)}) {
        const CharacterComparison comparison = compare_characters(*a, *b, kMillimetre);
        EXPECT_EQ(places_of(comparison), std::vector<std::string>());
        EXPECT_LE(comparison.worst.value(), 1e-5);
    }
    targets.meshes[0].targets[1].positions[5].z += 0.1f;
    EXPECT_TRUE(has(compare_characters(frames, targets, kMillimetre), "with target #1"));
    EXPECT_TRUE(has(compare_characters(frames, targets, kMillimetre), "clip \"walk\""));
}

TEST(CompareCharacters, NothingIsMeasuredBetweenOtherSkeletons) {
    const Scene a = drawn_scene();
    Scene b = a;
    b.joints[0].name = "another";
    const CharacterComparison comparison = compare_characters(a, b, kMillimetre);
    EXPECT_FALSE(comparison.differences.empty());
    EXPECT_FALSE(comparison.worst.has_value());
}

TEST(CompareCharacters, WhatIsMissingIsNamedOnItsSide) {
    const Scene a = drawn_scene();
    Scene b = a;
    auto& indices = b.meshes[0].submeshes[0].indices;
    indices.erase(indices.begin() + 9, indices.begin() + 12);
    CharacterComparison comparison = compare_characters(a, b, kMillimetre);
    ASSERT_EQ(comparison.differences.size(), 1u);
    EXPECT_EQ(comparison.differences[0].kind, Kind::only_in_a);
    EXPECT_TRUE(has(comparison, "mesh \"body\", triangle 9 10 11 of material \"skin\""));
    comparison = compare_characters(b, a, kMillimetre);
    ASSERT_EQ(comparison.differences.size(), 1u);
    EXPECT_EQ(comparison.differences[0].kind, Kind::only_in_b);

    b = a;
    b.clips.pop_back();
    EXPECT_TRUE(has(compare_characters(a, b, kMillimetre), "clip \"run\""));
    b = a;
    b.joints[7].name = "other";
    EXPECT_EQ(places_of(compare_characters(a, b, kMillimetre)),
              (std::vector<std::string>{"joint \"joint 7\"", "joint \"other\""}));
}

TEST(CompareCharacters, ATriangleOfAnotherMaterialIsAnother) {
    const Scene a = drawn_scene();
    Scene b = a;
    auto& from = b.meshes[0].submeshes[0].indices;
    b.meshes[0].submeshes[1].indices.insert(b.meshes[0].submeshes[1].indices.end(), from.end() - 3, from.end());
    from.resize(from.size() - 3);
    EXPECT_EQ(compare_characters(a, b, kMillimetre).differences.size(), 2u);
}

/// A square of cells of 1 mm, carried by joint 0.
Scene fine_scene() {
    constexpr std::uint32_t kSide = 12;
    Scene scene;
    scene.joints.resize(1);
    Mesh& mesh = scene.meshes.emplace_back();
    mesh.joint = 0;
    Submesh& submesh = mesh.submeshes.emplace_back();
    for (std::uint32_t y = 0; y <= kSide; ++y) {
        for (std::uint32_t x = 0; x <= kSide; ++x) {
            mesh.positions.push_back({1e-3f * static_cast<float>(x), 1e-3f * static_cast<float>(y), 0.0f});
            if (x == kSide || y == kSide) continue;
            const std::uint32_t v = y * (kSide + 1) + x;
            submesh.indices.insert(submesh.indices.end(), {v, v + 1, v + kSide + 2, v, v + kSide + 2, v + kSide + 1});
        }
    }
    return scene;
}

TEST(CompareCharacters, ManyWithinTheToleranceFindTheirPartners) {
    const Scene a = fine_scene();
    Scene b = a;
    test::Numbers numbers(3);
    for (glm::vec3& position : b.meshes[0].positions) position += numbers.vector(6e-4f);
    auto& indices = b.meshes[0].submeshes[0].indices;
    std::rotate(indices.begin(), indices.begin() + 300, indices.end());
    const CharacterComparison comparison = compare_characters(a, b, {4e-3, false});
    EXPECT_EQ(places_of(comparison), std::vector<std::string>());
    EXPECT_LE(comparison.worst, 4e-3);
    EXPECT_FALSE(compare_characters(a, b, {1e-4, false}).differences.empty());
}

TEST(CompareCharacters, LayersAtOnePlaceAreToldApartByHowTheyMove) {
    Scene a;
    a.joints.resize(3);
    a.joints[1].parent = a.joints[2].parent = 0;
    a.joints[0].name = "root";
    a.joints[1].name = "left";
    a.joints[2].name = "right";
    Mesh& mesh = a.meshes.emplace_back();
    mesh.joint = 0;
    mesh.influences = 1;
    mesh.palette = {{1, 2}, {glm::mat4(1.0f), glm::mat4(1.0f)}};
    for (const std::uint32_t bone : {0u, 1u}) {
        mesh.positions.insert(mesh.positions.end(), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
        mesh.bones.insert(mesh.bones.end(), {bone, bone, bone});
        mesh.weights.insert(mesh.weights.end(), {1, 1, 1});
    }
    mesh.submeshes = {{Topology::triangles, kNone, {0, 1, 2, 3, 4, 5}}};
    a.clips.push_back(
        {"sway", false, {{TrackPath::translation, Interpolation::linear, 1, 3, {0, 1}, {0, 0, 0, 0, 0, 1}}}, {}});
    Scene b = a;
    b.meshes[0].submeshes[0].indices = {3, 4, 5, 0, 1, 2};
    EXPECT_EQ(compare_characters(a, b, kMillimetre).worst, 0.0);
    b.meshes[0].bones = {0, 0, 0, 0, 0, 0};
    EXPECT_NEAR(compare_characters(a, b, kMillimetre).worst.value(), 1.0, 1e-6);
}

TEST(CompareCharacters, OtherLooksAreNamed) {
    Scene a = drawn_scene();
    a.meshes[0].normals.assign(60, glm::vec3(0.0f, 1.0f, 0.0f));
    a.meshes[0].texture_coords.push_back({"", 0, 2, std::vector<float>(120, 0.5f)});
    Scene b = a;
    b.meshes[0].normals[4] = glm::vec3(0.0f, 0.99f, 0.1f);
    b.meshes[0].texture_coords[0].values[10] = 0.6f;
    const CharacterComparison comparison = compare_characters(a, b, kMillimetre);
    EXPECT_EQ(places_of(comparison),
              (std::vector<std::string>{"mesh \"body\", normals", "mesh \"body\", texture coordinates 0"}));
    EXPECT_NE(comparison.differences[0].what.find("at vertex 4"), std::string::npos);
    b.meshes[0].normals.clear();
    EXPECT_EQ(compare_characters(a, b, kMillimetre).differences[0].kind, Kind::only_in_a);
}

}  // namespace
}  // namespace bendy::converter::compare_characters_test
