#include "optimise/compact/round_weights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace bendy::converter::round_weights_test {
namespace {

MorphTarget target_of(std::vector<glm::vec3> positions) {
    MorphTarget target;
    target.positions = std::move(positions);
    return target;
}

/// Two vertices: the first moves by up to a metre, the second by up to four.
Mesh faces() {
    Mesh mesh;
    mesh.positions.resize(2);
    mesh.targets = {target_of({{1, 0, 0}, {0, 0, 0}}), target_of({{0, 0, 0}, {0, 4, 0}}), target_of({}),
                    target_of({{0, 0, 0}, {0, 0, 0}})};
    return mesh;
}

bool is_power_of_two(float step) {
    int exponent = 0;
    return std::frexp(step, &exponent) == 0.5f;
}

TEST(RoundWeights, StepsFollowFromTheReach) {
    const std::vector<float> steps = weight_steps(faces(), 1e-4);
    ASSERT_EQ(steps.size(), 4u);
    for (const float step : steps) EXPECT_TRUE(is_power_of_two(step));
    EXPECT_LE(0.5 * steps[0] * 1.0, 1e-4);
    EXPECT_GT(2.0 * steps[0] * 1.0, 1e-4) << "no finer than needed";
    EXPECT_EQ(steps[1], steps[0] / 4.0f);
    EXPECT_EQ(steps[2], 1.0f / 1024.0f) << "moves nothing";
    EXPECT_EQ(steps[3], 1.0f / 1024.0f);
    EXPECT_EQ(weight_steps(faces(), 1e3)[0], 1.0f / 1024.0f) << "never coarser";
    EXPECT_EQ(weight_steps(faces(), 0.0)[0], std::ldexp(1.0f, -23));
}

TEST(RoundWeights, TargetsOfOneVertexShareTheBound) {
    Mesh mesh;
    mesh.positions.resize(1);
    for (int k = 0; k < 16; ++k) mesh.targets.push_back(target_of({{1, 0, 0}}));
    const float all = weight_steps(mesh, 1e-4)[0];
    mesh.targets.resize(1);
    EXPECT_EQ(weight_steps(mesh, 1e-4)[0], 4.0f * all) << "as independent errors add up";
}

TEST(RoundWeights, OnlyStepAndLinearTracksOfWeights) {
    const std::vector<std::vector<float>> steps{{0.25f, 0.5f}};
    Clip clip;
    Track track{TrackPath::weights, Interpolation::linear, 0, 2, {0.0f, 1.0f}, {0.3f, 0.3f, 1.0f, 0.0f}};
    clip.tracks.push_back(track);
    track.interpolation = Interpolation::cubic;
    clip.tracks.push_back(track);
    clip.tracks.push_back({TrackPath::translation, Interpolation::linear, 0, 3, {0.0f}, {0.3f, 0.3f, 0.3f}});
    const Clip before = clip;
    round_weights(clip, steps, 0);
    EXPECT_EQ(clip.tracks[0].values, (std::vector<float>{0.25f, 0.5f, 1.0f, 0.0f}));
    EXPECT_EQ(clip.tracks[1].values, before.tracks[1].values);
    EXPECT_EQ(clip.tracks[2].values, before.tracks[2].values);
    clip = before;
    round_weights(clip, steps, 1);
    EXPECT_EQ(clip.tracks[0].values, (std::vector<float>{0.25f, 0.25f, 1.0f, 0.0f}));
}

TEST(RoundWeights, HugeWeightsStayFinite) {
    Clip clip;
    const float huge = std::numeric_limits<float>::max();
    clip.tracks.push_back({TrackPath::weights, Interpolation::linear, 0, 1, {0.0f, 1.0f}, {huge, 0.3f}});
    round_weights(clip, {{0.25f}}, 0);
    EXPECT_EQ(clip.tracks[0].values, (std::vector<float>{huge, 0.25f}));
}

}  // namespace
}  // namespace bendy::converter::round_weights_test
