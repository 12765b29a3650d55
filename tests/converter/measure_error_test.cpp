#include "optimise/measure_error.h"

#include "converter/posed_scene.h"
#include "scene/evaluate.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

namespace bendy::converter::measure_error_test {
namespace {

/// The worst vertex of all, the slow way: every vertex at every time.
MeasuredError measure_slowly(const Scene& exact, const Scene& decoded) {
    MeasuredError worst;
    EvaluatedPose here;
    EvaluatedPose there;
    const auto measure = [&](std::uint32_t clip, double seconds) {
        for (std::uint32_t mesh = 0; mesh < exact.meshes.size(); ++mesh) {
            const auto a = evaluate_vertices(exact.meshes[mesh], here.morph_weights[mesh], here.joints);
            const auto b = evaluate_vertices(decoded.meshes[mesh], there.morph_weights[mesh], there.joints);
            for (std::uint32_t vertex = 0; vertex < a.size(); ++vertex) {
                const double error = glm::distance(a[vertex], b[vertex]);
                if (error > worst.metres) worst = {error, mesh, vertex, kNone, clip, seconds};
            }
        }
    };
    evaluate_rest(exact, here);
    evaluate_rest(decoded, there);
    measure(kNone, 0.0);
    for (std::uint32_t clip = 0; clip < exact.clips.size(); ++clip) {
        std::set<double> times;
        for (const Scene* scene : {&exact, &decoded}) {
            for (const Track& track : scene->clips[clip].tracks) times.insert(track.times.begin(), track.times.end());
        }
        if (times.empty()) continue;
        const double start = *times.begin();
        const double end = *times.rbegin();
        for (double k = 1.0; start + k / 240.0 < end; k += 1.0) times.insert(start + k / 240.0);
        for (const double seconds : times) {
            evaluate(exact, exact.clips[clip], seconds, here);
            evaluate(decoded, decoded.clips[clip], seconds, there);
            measure(clip, seconds);
        }
    }
    return worst;
}

Scene still_scene() {
    Scene scene;
    scene.joints.resize(2);
    scene.joints[1].parent = 0;
    Mesh mesh;
    mesh.joint = 0;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}};
    scene.meshes.push_back(mesh);
    return scene;
}

TEST(MeasureError, TheSameSceneHasNone) {
    const Scene scene = test::random_scene(1);
    const MeasuredError error = measure_error(scene, scene);
    EXPECT_EQ(error.metres, 0.0);
    EXPECT_EQ(error.mesh, kNone);
}

TEST(MeasureError, OneVertexMovedIsFound) {
    const Scene exact = still_scene();
    Scene decoded = exact;
    decoded.meshes[0].positions[2].x += 0.25f;
    const MeasuredError error = measure_error(exact, decoded);
    EXPECT_EQ(error.metres, 0.25);
    EXPECT_EQ(error.mesh, 0u);
    EXPECT_EQ(error.vertex, 2u);
    EXPECT_EQ(error.clip, kNone);
    EXPECT_EQ(error.joint, kNone);
}

TEST(MeasureError, AVertexIsFoundAtItsTime) {
    // Only half way between its two keys, which both scenes have alike, does the decoded one scale the mesh.
    Scene exact = still_scene();
    exact.clips.resize(2);
    exact.clips[1].tracks = {{TrackPath::scale, Interpolation::linear, 0, 3, {1, 3}, {1, 1, 1, 1, 1, 1}}};
    Scene decoded = exact;
    decoded.clips[1].tracks = {
        {TrackPath::scale, Interpolation::linear, 0, 3, {1, 2, 3}, {1, 1, 1, 1, 1.5f, 1, 1, 1, 1}}};
    const MeasuredError error = measure_error(exact, decoded);
    EXPECT_EQ(error.metres, 1.0);  // half of 2
    EXPECT_EQ(error.vertex, 2u);
    EXPECT_EQ(error.clip, 1u);
    EXPECT_EQ(error.seconds, 2.0);
}

TEST(MeasureError, TargetsCountByTheirWeights) {
    Scene exact = still_scene();
    exact.meshes[0].targets.resize(1);
    exact.meshes[0].targets[0].positions = {{}, {1, 0, 0}, {}};
    exact.clips.resize(1);
    exact.clips[0].tracks = {{TrackPath::weights, Interpolation::linear, 0, 1, {0, 1}, {0, 0.5f}}};
    Scene decoded = exact;
    decoded.meshes[0].targets[0].positions[1].y = 0.5f;
    const MeasuredError error = measure_error(exact, decoded);
    EXPECT_EQ(error.metres, 0.25);
    EXPECT_EQ(error.vertex, 1u);
    EXPECT_EQ(error.seconds, 1.0);
}

TEST(MeasureError, VerticesMayBeInOtherPlaces) {
    const Scene exact = still_scene();
    Scene decoded = exact;
    decoded.meshes[0].positions = {{0, 2, 0}, {0, 0.125f, 0}};
    const std::vector<std::vector<std::uint32_t>> maps{{1, kNone, 0}};
    const MeasuredError error = measure_error(exact, decoded, {.vertex_maps = maps});
    EXPECT_EQ(error.metres, 0.125);
    EXPECT_EQ(error.vertex, 0u);
}

TEST(MeasureError, AJointThatMovesNoVertexCounts) {
    const Scene exact = still_scene();
    Scene decoded = exact;
    decoded.joints[1].rest.translation.z = 3.0f;
    const MeasuredError error = measure_error(exact, decoded);
    EXPECT_EQ(error.metres, 3.0);
    EXPECT_EQ(error.joint, 1u);
    EXPECT_EQ(error.mesh, kNone);
}

TEST(MeasureError, ScenesThatCannotBeComparedAreInfinitelyWrong) {
    const double infinity = std::numeric_limits<double>::infinity();
    const Scene exact = still_scene();
    Scene decoded = exact;
    decoded.meshes[0].positions.pop_back();
    EXPECT_EQ(measure_error(exact, decoded).metres, infinity);
    decoded = exact;
    decoded.joints.pop_back();
    EXPECT_EQ(measure_error(exact, decoded).metres, infinity);
    decoded = exact;
    decoded.clips.resize(1);
    EXPECT_EQ(measure_error(exact, decoded).metres, infinity);
    decoded = exact;
    decoded.meshes[0].positions[0].x = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(measure_error(exact, decoded).metres, infinity);
    const std::vector<std::vector<std::uint32_t>> maps{{0, 1, 3}};
    EXPECT_EQ(measure_error(exact, exact, {.vertex_maps = maps}).metres, infinity);
}

/// Changes everything a little, as an encoder would.
Scene coarsened(const Scene& exact, std::uint32_t seed, float positions, float weights, float keys) {
    test::Numbers numbers(seed);
    Scene scene = exact;
    for (Mesh& mesh : scene.meshes) {
        for (glm::vec3& position : mesh.positions) position += numbers.vector(positions);
        for (MorphTarget& target : mesh.targets) {
            for (glm::vec3& position : target.positions) position += numbers.vector(positions);
        }
        for (std::size_t vertex = 0; vertex < mesh.weights.size(); vertex += mesh.influences + 0u) {
            const float moved = std::min(mesh.weights[vertex], numbers.between(0.0f, weights));
            mesh.weights[vertex] -= moved;
            mesh.weights[vertex + 2] += moved;
        }
    }
    for (Clip& clip : scene.clips) {
        for (Track& track : clip.tracks) {
            for (float& value : track.values) value += numbers.between(-keys, keys);
        }
    }
    return scene;
}

TEST(MeasureError, TheBoundsPassOverNoWorstVertex) {
    for (std::uint32_t seed = 0; seed < 24; ++seed) {
        const Scene exact = test::random_scene(seed);
        const Scene decoded = coarsened(exact, seed + 100, seed % 2 == 0 ? 1e-3f : 0.0f, seed % 3 == 0 ? 1e-2f : 0.0f,
                                        seed % 4 < 2 ? 1e-3f : 0.0f);
        const MeasuredError expected = measure_slowly(exact, decoded);
        const MeasuredError error = measure_error(exact, decoded);
        EXPECT_NEAR(error.metres, expected.metres, 1e-12 + 1e-9 * expected.metres) << seed;
        EXPECT_EQ(error.mesh, expected.mesh) << seed;
        EXPECT_EQ(error.clip, expected.clip) << seed;
    }
}

TEST(MeasureError, OfClipsInsideTheLimitTheWorstIsExact) {
    Scene exact = still_scene();
    Scene decoded = exact;
    constexpr std::array kErrors{0.25f, 0.5f, 0.125f, 2.0f, 0.5f};
    for (const float error : kErrors) {
        for (Scene* scene : {&exact, &decoded}) {
            const float x = scene == &exact ? 0.0f : error;
            scene->clips.emplace_back().tracks = {
                {TrackPath::translation, Interpolation::linear, 0, 3, {0, 1}, {x, 0, 0, x, 0, 0}}};
        }
    }
    const std::vector<std::uint32_t> clips{0, 1, 2, 3, 4};
    const std::vector<MeasuredError> found = measure_clips(exact, decoded, clips, {.limit = 1.0});
    ASSERT_EQ(found.size(), 6u);
    EXPECT_EQ(found[0].metres, 0.25);
    EXPECT_EQ(found[1].metres, 0.5);
    EXPECT_EQ(found[2].metres, 0.0);  // less than a clip before it: not found
    EXPECT_EQ(found[3].metres, 2.0);
    EXPECT_EQ(found[4].metres, 0.5);  // as much: the first of equals does not depend on the order of measuring
    EXPECT_EQ(found[5].metres, 0.0);
    const std::vector<MeasuredError> others = measure_clips(exact, decoded, clips, {.known = 0.75, .limit = 1.0});
    EXPECT_EQ(others[1].metres, 0.0);
    EXPECT_EQ(others[3].metres, 2.0);
}

TEST(MeasureError, ProgressEndsAtOne) {
    const Scene scene = test::random_scene(3);
    std::vector<double> told;
    measure_error(scene, scene, {.progress = [&](double part) { told.push_back(part); }});
    ASSERT_FALSE(told.empty());
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    EXPECT_EQ(told.back(), 1.0);
}

TEST(MeasureError, WithoutKeysThereIsNoProgress) {
    Scene scene = still_scene();
    scene.clips.resize(2);
    std::vector<double> told;
    EXPECT_EQ(measure_error(scene, scene, {.progress = [&](double part) { told.push_back(part); }}).metres, 0.0);
    EXPECT_TRUE(told.empty());
}

TEST(MeasureError, AnEndlessCycleEnds) {
    Scene scene = still_scene();
    scene.clips.resize(1);
    scene.clips[0].tracks = {{TrackPath::translation, Interpolation::linear, 0, 3, {0, 1e30f}, {0, 0, 0, 1, 1, 1}}};
    EXPECT_EQ(measure_error(scene, scene).metres, 0.0);
}

}  // namespace
}  // namespace bendy::converter::measure_error_test
