#include "convert/build_compact.h"

#include "converter/posed_scene.h"
#include "scene/evaluate.h"
#include "scene/frame_shapes.h"
#include "source_folder.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/converter/import.h>
#include <bendy/format/diagnostics.h>
#include <bendy/format/document.h>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <random>
#include <string>

namespace bendy::converter::build_compact_test {
namespace {

using test::Numbers;

/// As a library of clips is: joints and clips of linear tracks, not a vertex.
Scene skeleton_with_clips(std::uint32_t seed) {
    Numbers numbers(seed);
    Scene scene = test::random_scene(seed);
    scene.meshes.clear();
    for (Clip& clip : scene.clips) {
        clip.tracks.clear();
        for (std::uint32_t joint = 0; joint < scene.joints.size(); ++joint) {
            for (const TrackPath path : {TrackPath::translation, TrackPath::rotation, TrackPath::scale})
                clip.tracks.push_back(test::random_track(numbers, path, Interpolation::linear, joint));
        }
    }
    return scene;
}

Scene lone_joint_that_turns() {
    Scene scene;
    scene.joints.resize(1);
    Clip turn;
    turn.tracks = {{TrackPath::rotation,
                    Interpolation::linear,
                    0,
                    4,
                    {0.0f, 0.5f, 1.0f},
                    {0, 0, 0, 1, 0, 0.6f, 0, 0.8f, 0.6f, 0, 0, 0.8f}}};
    scene.clips = {turn};
    return scene;
}

/// A snake: all joints at one height.
Scene flat_chain() {
    Scene scene;
    scene.joints.resize(6);
    Clip bend;
    for (std::uint32_t joint = 0; joint < scene.joints.size(); ++joint) {
        if (joint > 0) {
            scene.joints[joint].parent = joint - 1;
            scene.joints[joint].rest.translation = {0.25f, 0.0f, 0.0f};
        }
        bend.tracks.push_back(
            {TrackPath::rotation, Interpolation::linear, joint, 4, {0.0f, 1.0f}, {0, 0, 0, 1, 0, 0.28f, 0, 0.96f}});
    }
    scene.clips = {bend};
    return scene;
}

/// The farthest that a joint's origin, or a point 1 % of `size` from it on an axis, is from where the other scene has
/// it.
double farthest(const Scene& a, const Scene& b, double size) {
    double worst = 0.0;
    EvaluatedPose here;
    EvaluatedPose there;
    for (std::size_t clip = 0; clip < a.clips.size(); ++clip) {
        const ClipSpan span = span_of(a.clips[clip]);
        for (int k = 0; k <= 100; ++k) {
            evaluate(a, a.clips[clip], span.at(k / 100.0), here);
            evaluate(b, b.clips[clip], span.at(k / 100.0), there);
            for (std::size_t joint = 0; joint < a.joints.size(); ++joint) {
                for (const glm::dvec4& point : {glm::dvec4(0, 0, 0, 1), glm::dvec4(0.01 * size, 0, 0, 1),
                                                glm::dvec4(0, 0.01 * size, 0, 1), glm::dvec4(0, 0, 0.01 * size, 1)}) {
                    worst = std::max(worst, glm::length((here.joints[joint] - there.joints[joint]) * point));
                }
            }
        }
    }
    return worst;
}

TEST(BuildCompact, EveryBoundIsKeptAndNoneGivesTheExactFile) {
    Report unheard;
    const auto scene = import_gltf(source_folder() / "examples" / "tentacle.glb", {}, unheard);
    ASSERT_TRUE(scene) << scene.error().message;
    for (const double share : {5e-5, 1e-3, 1e-2}) {
        Report report;
        const auto bytes = build_compact(*scene, {.bound = {share, true}}, "test", report);
        ASSERT_TRUE(report.compact) << share;
        EXPECT_GT(report.compact->measured_error, 0.0);
        EXPECT_LE(report.compact->measured_error, report.compact->max_error);
        EXPECT_DOUBLE_EQ(report.compact->max_error, share * report.compact->height);
        EXPECT_TRUE(validate(bytes).empty());
    }
}

TEST(BuildCompact, WithoutASkinTheJointsMotionIsBounded) {
    std::vector<Scene> scenes{lone_joint_that_turns(), flat_chain()};
    for (std::uint32_t seed = 1; seed <= 5; ++seed) scenes.push_back(skeleton_with_clips(seed));
    for (std::size_t number = 0; number < scenes.size(); ++number) {
        SCOPED_TRACE(number);
        for (const double share : {5e-5, 1e-2}) {
            Report report;
            const auto bytes = build_compact(scenes[number], {.bound = {share, true}}, "test", report);
            ASSERT_TRUE(report.compact);
            EXPECT_GT(report.compact->max_error, 0.0);
            EXPECT_LE(report.compact->measured_error, report.compact->max_error);
            const auto decoded = import_bendy(bytes, report);
            ASSERT_TRUE(decoded);
            EXPECT_LE(farthest(scenes[number], *decoded, report.compact->height), report.compact->max_error);
            EXPECT_LT(bytes.size(), build_chunks(scenes[number], "test", report).size());
        }
    }
}

/// A clip that rests for its whole length, one that stands still elsewhere, and one whose longest track stands still.
Scene clips_with_still_tracks() {
    Scene scene = flat_chain();
    const auto still = [&](std::vector<float> times, const glm::vec3& at) {
        Track track{TrackPath::translation, Interpolation::linear, 1, 3, std::move(times), {}};
        for (std::size_t key = 0; key < track.times.size(); ++key) test::put(track.values, at);
        return track;
    };
    const glm::vec3 rest = scene.joints[1].rest.translation;
    Clip resting;
    resting.tracks = {still({0.0f, 2.5f}, rest)};
    Clip elsewhere;
    elsewhere.tracks = {still({0.25f, 0.5f, 2.1f}, rest + glm::vec3(0.0f, 0.1f, 0.0f))};
    Clip longer = scene.clips.front();
    longer.tracks.push_back(still({-0.3f, 2.7f}, rest));
    scene.clips.insert(scene.clips.end(), {resting, elsewhere, longer});
    return scene;
}

TEST(BuildCompact, ClipsKeepTheirLength) {
    Scene with_skin = clips_with_still_tracks();
    with_skin.meshes.resize(1);
    with_skin.meshes[0].joint = 5;
    with_skin.meshes[0].positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    with_skin.meshes[0].submeshes = {{Topology::triangles, kNone, {0, 1, 2}}};
    for (const Scene& scene : {clips_with_still_tracks(), with_skin}) {
        Report report;
        const auto compact = build_compact(scene, {.bound = {1e-4, true}}, "test", report);
        ASSERT_TRUE(report.compact);
        EXPECT_TRUE(validate(compact).empty());
        const auto decoded = import_bendy(compact, report);
        ASSERT_TRUE(decoded);
        const auto again = import_bendy(build_chunks(*decoded, "test", report), report);
        ASSERT_TRUE(again);
        for (std::size_t clip = 0; clip < scene.clips.size(); ++clip) {
            SCOPED_TRACE(clip);
            const ClipSpan span = span_of(scene.clips[clip]);
            for (const Scene* read : {&*decoded, &*again}) {
                EXPECT_EQ(span_of(read->clips[clip]).start, span.start);
                EXPECT_EQ(span_of(read->clips[clip]).end, span.end);
            }
        }
        EXPECT_TRUE(report.warnings().empty());
    }
}

TEST(BuildCompact, BytesDoNotDependOnThreads) {
    const Scene scene = skeleton_with_clips(3);
    ASSERT_GT(scene.clips.size(), 1u);
    Report report;
    const auto alone = build_compact(scene, {.bound = {1e-4, true}}, "test", report);
    for (const std::size_t threads : {2u, 5u}) {
        Report with_threads;
        std::vector<double> told;
        const auto bytes = build_compact(
            scene, {.bound = {1e-4, true}, .progress = [&](double done) { told.push_back(done); }, .threads = threads},
            "test", with_threads);
        EXPECT_EQ(bytes, alone);
        EXPECT_EQ(with_threads.compact->place, report.compact->place);
        EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    }
}

/// A rigid cloud of triangles, one target that moves all of it, and a clip of that target's weight.
Scene morphing_cloud() {
    std::mt19937 random(5);
    const auto fraction = [&] { return static_cast<float>(random() % 10001) / 10000.0f; };
    Scene scene;
    scene.joints.resize(1);
    Mesh& mesh = scene.meshes.emplace_back();
    mesh.joint = 0;
    MorphTarget& target = mesh.targets.emplace_back();
    Submesh& submesh = mesh.submeshes.emplace_back();
    for (std::uint32_t vertex = 0; vertex < 300; ++vertex) {
        const float x = fraction();
        const float y = fraction();
        const float z = fraction();
        mesh.positions.emplace_back(x, y, z);
        target.positions.emplace_back(0.3f * y, 0.3f * z, 0.3f * x);
        submesh.indices.push_back(vertex);
    }
    Track& track = scene.clips.emplace_back().tracks.emplace_back();
    track = {TrackPath::weights, Interpolation::linear, 0, 1, {0.0f, 1.0f}, {0.0f, 1.0f}};
    return scene;
}

TEST(BuildCompact, AClipThatOnlyMorphsLeavesTheBoundToTheGeometry) {
    Report report;
    build_compact(morphing_cloud(), {.bound = {1e-3, false}}, "test", report);
    ASSERT_TRUE(report.compact);
    EXPECT_GT(report.compact->measured_error, 0.35e-3);  // the share that moving joints leave to the geometry
    EXPECT_LE(report.compact->measured_error, 1e-3);
}

/// Four vertices, of which the last is at this place, on a joint of this scale.
Scene with_far_vertex(const glm::vec3& place, float scale) {
    Scene scene;
    scene.joints.resize(1);
    scene.joints[0].rest.scale = glm::vec3(scale);
    Mesh& mesh = scene.meshes.emplace_back();
    mesh.name = "Body";
    mesh.joint = 0;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, place};
    mesh.submeshes.push_back({Topology::triangles, kNone, {0, 1, 2, 1, 3, 2}});
    return scene;
}

TEST(BuildCompact, AVertexAtAnyNumberIsHeld) {
    for (const float far : {1e20f, 1e38f, -3e38f, 1e-40f}) {
        Report report;
        const auto bytes = build_compact(with_far_vertex({far, 0, far}, 1.0f), {}, "test", report);
        EXPECT_TRUE(validate(bytes).empty()) << far;
        const Result<Scene, ImportError> read = import_bendy(bytes, report);
        ASSERT_TRUE(read.has_value()) << far << ": " << read.error().message;
    }
}

TEST(BuildCompact, WhatTheBoundCannotHoldIsNamed) {
    Report report;
    auto bytes = build_compact(with_far_vertex({0, 1e20f, 0}, 1e20f), {}, "test", report);
    EXPECT_TRUE(validate(bytes).empty());
    EXPECT_FALSE(report.compact.has_value());
    ASSERT_EQ(report.warnings().size(), 1u);
    EXPECT_EQ(report.warnings()[0].message, "the character's height is too large for an error bound: written exactly");
    EXPECT_EQ(report.warnings()[0].first_place, "mesh \"Body\", vertex 3");

    Report of_bound;
    CompactOptions options;
    options.bound = {1e39, false};
    bytes = build_compact(with_far_vertex({0, 2, 0}, 1.0f), options, "test", of_bound);
    EXPECT_TRUE(validate(bytes).empty());
    ASSERT_EQ(of_bound.warnings().size(), 1u);
    EXPECT_EQ(of_bound.warnings()[0].message, "the error bound is too large a number of metres: written exactly");

    Report of_steps;
    options.bound = {1e-4, false};
    bytes = build_compact(with_far_vertex({0, 1e20f, 0}, 1.0f), options, "test", of_steps);
    EXPECT_TRUE(validate(bytes).empty());
    ASSERT_EQ(of_steps.warnings().size(), 1u);
    EXPECT_EQ(of_steps.warnings()[0].message,
              "positions written exactly: steps as small as the error bound do not reach that far");
    EXPECT_EQ(of_steps.warnings()[0].first_place, "mesh \"Body\", vertex 3");
}

TEST(BuildCompact, KeysAtDenormalTimesAreHeld) {
    Scene scene = with_far_vertex({1, 1, 0}, 1.0f);
    constexpr float kLeast = std::numeric_limits<float>::denorm_min();
    scene.clips.emplace_back().tracks = {
        {TrackPath::translation, Interpolation::linear, 0, 3, {0.0f, kLeast}, {0, 0, 0, 1, 0, 0}},
        {TrackPath::scale, Interpolation::linear, 0, 3, {0.0f, kLeast}, {1, 1, 1, 1, 1, 1}}};
    for (const bool moves : {true, false}) {
        if (!moves) scene.clips[0].tracks.erase(scene.clips[0].tracks.begin());
        Report report;
        EXPECT_TRUE(validate(build_compact(scene, {}, "test", report)).empty());
        EXPECT_TRUE(report.warnings().empty());
    }
}

}  // namespace
}  // namespace bendy::converter::build_compact_test
