#include "scene/evaluate.h"

#include "converter/posed_scene.h"
#include "format/sample_file.h"
#include "source_folder.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/converter/import.h>
#include <bendy/runtime.h>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace bendy::converter::evaluate_test {
namespace {

Track make_track(TrackPath path, Interpolation interpolation, std::uint32_t components, std::vector<float> times,
                 std::vector<float> values) {
    return {path, interpolation, 0, components, std::move(times), std::move(values)};
}

std::vector<double> value_at(const Track& track, double seconds) {
    std::vector<double> value;
    evaluate_track(track, seconds, value);
    return value;
}

TEST(Evaluate, StepHoldsAndLinearIsStraight) {
    Track track = make_track(TrackPath::translation, Interpolation::linear, 3, {1, 2, 4}, {0, 0, 0, 8, 0, 0, 8, 4, 0});
    EXPECT_EQ(value_at(track, 0.0), (std::vector<double>{0, 0, 0}));
    EXPECT_EQ(value_at(track, 1.25), (std::vector<double>{2, 0, 0}));
    EXPECT_EQ(value_at(track, 3.0), (std::vector<double>{8, 2, 0}));
    EXPECT_EQ(value_at(track, 9.0), (std::vector<double>{8, 4, 0}));
    track.interpolation = Interpolation::step;
    EXPECT_EQ(value_at(track, 1.999), (std::vector<double>{0, 0, 0}));
    EXPECT_EQ(value_at(track, 2.0), (std::vector<double>{8, 0, 0}));
}

TEST(Evaluate, LinearRotationsKeepTheirSpeedAndTakeTheShortWay) {
    const double angle = 2.8;  // radians from one key to the next
    const auto half = [](double a) { return static_cast<float>(a / 2.0); };
    for (const float sign : {1.0f, -1.0f}) {
        const Track track = make_track(TrackPath::rotation, Interpolation::linear, 4, {0, 1},
                                       {0, 0, 0, 1, 0, sign * std::sin(half(angle)), 0, sign * std::cos(half(angle))});
        for (double u = 0.0; u <= 1.0; u += 1.0 / 64.0) {
            std::vector<double> q = value_at(track, u);
            if (q[3] < 0.0) q = {0, -q[1], 0, -q[3]};  // the same rotation
            EXPECT_NEAR(2.0 * std::atan2(q[1], q[3]), u * angle, 1e-6);
            EXPECT_NEAR(q[1] * q[1] + q[3] * q[3], 1.0, 1e-6);
        }
    }
}

TEST(Evaluate, CubicIsASplineThroughItsKeys) {
    // x^3 on [0, 2]: its tangents are 0 and 12.
    const Track track = make_track(TrackPath::translation, Interpolation::cubic, 3, {0, 2},
                                   {0, 0, 0, 0, 0, 0, 0, 0, 0, 12, 0, 0, 8, 0, 0, 0, 0, 0});
    for (double x = 0.0; x <= 2.0; x += 0.125) EXPECT_NEAR(value_at(track, x)[0], x * x * x, 1e-12);
}

/// Holds the scene against what the runtime makes of its file, in the rest pose and all over each clip.
void compare_with_runtime(const Scene& scene, double tolerance) {
    Report report;
    const std::vector<std::byte> bytes = build_chunks(scene, "test", report);
    const Result<Model> model = Model::from_memory(bytes);
    ASSERT_TRUE(model);
    Pose pose(*model);
    EvaluatedPose evaluated;
    const auto compare = [&](float seconds) {
        for (std::uint32_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
            const auto expected =
                evaluate_vertices(scene.meshes[mesh], evaluated.morph_weights[mesh], evaluated.joints);
            std::vector<glm::vec3> skinned(expected.size());
            ASSERT_TRUE(skin(pose, {.mesh = mesh, .out = {.positions = skinned}}));
            double worst = 0.0;
            double size = 1.0;
            for (std::size_t vertex = 0; vertex < expected.size(); ++vertex) {
                worst = std::max(worst, glm::distance(expected[vertex], glm::dvec3(skinned[vertex])));
                size = std::max(size, glm::length(expected[vertex]));
            }
            EXPECT_LE(worst, tolerance * size) << "mesh " << mesh << " at " << seconds;
        }
    };
    pose.set_rest();
    evaluate_rest(scene, evaluated);
    compare(-1.0f);
    for (std::size_t clip = 0; clip < scene.clips.size(); ++clip) {
        const Clip& source = scene.clips[clip];
        const float start = model->clips()[clip].start;
        const float length = model->clips()[clip].end - start;
        for (int k = -1; k <= 21; ++k) {
            const float seconds = start + length * static_cast<float>(k) / 20.0f;
            EXPECT_TRUE(sample(pose, &model->clips()[clip], seconds));
            evaluate(scene, source, seconds, evaluated);
            compare(seconds);
        }
    }
}

TEST(Evaluate, AgreesWithTheRuntimeOnRandomScenes) {
    for (std::uint32_t seed = 0; seed < 20; ++seed) compare_with_runtime(test::random_scene(seed), 2e-6);
}

TEST(Evaluate, AgreesWithTheRuntimeOnEveryChunk) {
    Report report;
    const auto scene = import_bendy(bendy::test::sample_file(), report);
    ASSERT_TRUE(scene);
    compare_with_runtime(*scene, 2e-6);
}

TEST(Evaluate, AgreesWithTheRuntimeOnTheExamples) {
    for (const char* name : {"mannequin.glb", "tentacle.glb"}) {
        Report report;
        const auto scene = import_gltf(source_folder() / "examples" / name, {}, report);
        ASSERT_TRUE(scene);
        compare_with_runtime(*scene, 2e-6);
    }
}

TEST(Evaluate, FollowsTheJointsThatAreNeeded) {
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
        const Scene scene = test::random_scene(seed);
        for (const Clip& clip : scene.clips) {
            ClipEvaluator all(scene, clip);
            ClipEvaluator some(scene, clip);
            std::vector<bool> needed(scene.joints.size());
            for (std::size_t joint = seed % 3; joint < needed.size(); joint += 3) needed[joint] = true;
            EvaluatedPose right;
            EvaluatedPose found;
            some.follow(some.moved(), needed, found);
            for (const double seconds : {0.0, 0.31, 1.7}) {
                all.at(seconds, right);
                some.at(seconds, found);
                for (std::size_t joint = 0; joint < needed.size(); ++joint) {
                    const std::uint32_t carrier = some.carriers()[joint];
                    glm::dmat4 place = some.to_carriers()[joint];
                    if (carrier != kNone) place = found.joints[carrier] * place;
                    for (int c = 0; c < 4; ++c) {
                        EXPECT_LT(glm::distance(place[c], right.joints[joint][c]), 1e-12);
                        if (needed[joint]) {
                            EXPECT_LT(glm::distance(found.joints[joint][c], place[c]), 1e-12);
                        }
                    }
                }
            }
        }
    }
}

TEST(Evaluate, JointsThatNothingNeedsCostNothing) {
    Scene scene;
    scene.joints.resize(1000);
    for (std::uint32_t joint = 1; joint < 1000; ++joint) scene.joints[joint].parent = joint - 1;
    Clip& clip = scene.clips.emplace_back();
    for (const std::uint32_t joint : {0u, 700u}) {
        Track& track = clip.tracks.emplace_back();
        track.target = joint;
        track.path = TrackPath::translation;
        track.components = 3;
        track.times = {0.0f, 1.0f};
        track.values = {0, 0, 0, 1, 0, 0};
    }
    ClipEvaluator evaluator(scene, clip);
    EvaluatedPose pose;
    evaluator.follow(evaluator.moved(), std::vector<bool>(1000), pose);
    EXPECT_EQ(evaluator.computed(), 2u);
    evaluator.at(1.0, pose);
    EXPECT_EQ(pose.joints[700][3].x, 2.0);
}

}  // namespace
}  // namespace bendy::converter::evaluate_test
