#include <bendy/runtime/bounds.h>

#include <bendy/runtime/skin.h>

#include "pose/pose_state.h"
#include "runtime/build_model.h"
#include "runtime/limb_model.h"
#include "runtime/local_joints.h"

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace bendy::bounds_test {
namespace {

using test::Owned;

std::vector<glm::vec3> skinned(const Model& model, Pose& pose) {
    std::vector<glm::vec3> positions(model.vertex_count());
    EXPECT_TRUE(skin(pose, {.out = {.positions = positions}}));
    return positions;
}

Box around(const std::vector<glm::vec3>& points) {
    Box box;
    for (const glm::vec3& point : points) {
        for (int c = 0; c < 3; ++c) {
            box.minimum[c] = std::min(box.minimum[c], point[c]);
            box.maximum[c] = std::max(box.maximum[c], point[c]);
        }
    }
    return box;
}

float longest(const Box& box) {
    float most = 0.0f;
    for (int c = 0; c < 3; ++c) most = std::max(most, box.maximum[c] - box.minimum[c]);
    return most;
}

void expect_inside(const std::vector<glm::vec3>& points, const Box& box) {
    std::size_t outside = 0;
    for (const glm::vec3& point : points) outside += box.contains(point) ? 0 : 1;
    EXPECT_EQ(outside, 0u);
}

TEST(Bounds, OfOneJointByHand) {
    test::ModelSpec spec;
    spec.joints.resize(1);
    spec.joints[0].rest = test::moved(0, 10, 0);
    spec.meshes.resize(1);
    spec.meshes[0].joint = 0;
    spec.meshes[0].positions = {{1, 2, 3}, {-1, 5, 3}, {0, 4, -4}};
    const Owned model(test::build_file(spec));
    const Bounds bounds(*model);
    EXPECT_EQ(bounds.joint(0).minimum, glm::vec3(-1, 2, -4));
    EXPECT_EQ(bounds.joint(0).maximum, glm::vec3(1, 5, 3));
    Pose pose(*model);
    test::local_of(pose, 0)->rotation = glm::quat(std::sqrt(0.5f), 0, 0, std::sqrt(0.5f));  // x to y, y to -x
    const Box box = *bounds.of(pose);
    EXPECT_TRUE(PoseState::of(pose).stale.is_empty());
    const glm::vec3 minimum(-5, 9, -4);
    const glm::vec3 maximum(-2, 11, 3);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(box.minimum[c], minimum[c], 1e-4);
        EXPECT_NEAR(box.maximum[c], maximum[c], 1e-4);
    }
    expect_inside(skinned(*model, pose), box);
}

TEST(Bounds, HoldEverySkinnedVertexInAnyPose) {
    for (unsigned seed = 1; seed <= 6; ++seed) {
        test::LimbModel limb(seed);
        const Owned model(test::build_file(limb.spec));
        const Bounds bounds(*model);
        Pose pose(*model);
        expect_inside(skinned(*model, pose), *bounds.of(pose));
        for (int round = 0; round < 60; ++round) {
            limb.pose_at_random(pose, round % 3 == 0, round % 2 == 0);
            const auto positions = skinned(*model, pose);
            const Box box = *bounds.of(pose);
            expect_inside(positions, box);
            Box all = around({positions.end() - test::LimbModel::kStill, positions.end()});
            for (std::uint32_t joint = 0; joint < model->joints().size(); ++joint)
                all = unite(all, *bounds.of(pose, joint));
            for (int c = 0; c < 3; ++c) {  // but for what weights lack to a sum of 1
                EXPECT_NEAR(all.minimum[c], box.minimum[c], 1e-3);
                EXPECT_NEAR(all.maximum[c], box.maximum[c], 1e-3);
            }
        }
    }
}

TEST(Bounds, AreTightOnLimbs) {
    // Cylinders about bones: bounds are at most 1.5 times as long as what they hold, without targets.
    for (unsigned seed = 1; seed <= 6; ++seed) {
        test::LimbModel limb(seed);
        const Owned model(test::build_file(limb.spec));
        const Bounds bounds(*model);
        Pose pose(*model);
        for (int round = 0; round < 40; ++round) {
            limb.pose_at_random(pose, false, false);
            const float is = longest(*bounds.of(pose));
            EXPECT_LE(is, 1.5f * longest(around(skinned(*model, pose))));
        }
        pose.set_rest();
        EXPECT_LE(longest(*bounds.of(pose)), 1.15f * longest(around(skinned(*model, pose))));
    }
}

TEST(Bounds, WeightsThatAreNotAverages) {
    // Sums of 1/2 and 2, weights below zero, none at all: none is refused, each vertex is held.
    test::ModelSpec spec;
    spec.joints.resize(2);
    spec.joints[1].parent = 0;
    test::MeshSpec mesh;
    std::vector<std::uint8_t> bones;
    std::vector<float> weights;
    for (const auto& [a, b] : std::vector<std::pair<float, float>>{{0.25f, 0.25f}, {1, 1}, {1.5f, -0.5f}, {0, 0}}) {
        mesh.positions.emplace_back(10, 11, 12);
        bones.insert(bones.end(), {0, 1});
        weights.insert(weights.end(), {a, b});
    }
    mesh.more = {test::make_leaf(FourCC("BONE"), test::stream_payload<std::uint8_t>(2, bones)),
                 test::make_leaf(FourCC("WGHT"), test::stream_payload<float>(2, weights)),
                 test::palette_leaf({0, 1}, {glm::mat4(1.0f), glm::mat4(1.0f)})};
    spec.meshes = {mesh};
    const Owned model(test::build_file(spec));
    const Bounds bounds(*model);
    Pose pose(*model);
    test::local_of(pose, 1)->translation = {30, -40, 5};
    const auto positions = skinned(*model, pose);
    EXPECT_EQ(positions[0], glm::vec3(0.25f * 50, 0.25f * -18, 0.25f * 29));
    EXPECT_EQ(positions[3], glm::vec3(0));
    expect_inside(positions, *bounds.of(pose));
}

TEST(Bounds, OfNothing) {
    test::ModelSpec spec;
    spec.joints.resize(2);
    spec.joints[1].parent = 0;
    const Owned model(test::build_file(spec));
    const Bounds bounds(*model);
    Pose pose(*model);
    EXPECT_TRUE(bounds.of(pose)->is_empty());
    EXPECT_TRUE(bounds.of(pose, 1)->is_empty());
    EXPECT_TRUE(bounds.joint(1).is_empty());
    EXPECT_FALSE(bounds.of(pose)->contains({0, 0, 0}));
}

TEST(Bounds, WhatIsNotFiniteIsLeftOut) {
    test::ModelSpec spec;
    spec.joints.resize(2);
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    spec.meshes.resize(3);
    spec.meshes[0].joint = 0;
    spec.meshes[0].positions = {{1, 2, 3}, {kNan, 0, 0}, {0, kInfinity, 0}, {-1, 0, 0}};
    spec.meshes[1].joint = 1;
    spec.meshes[1].positions = {{7, 7, 7}};
    spec.meshes[2].positions = {{-2, 0, 0}};  // nothing moves it
    const Owned model(test::build_file(spec));
    const Bounds bounds(*model);
    Pose pose(*model);
    test::local_of(pose, 1)->translation.x = kNan;
    const Box box = *bounds.of(pose);
    for (const float number :
         {box.minimum.x + 2, box.minimum.y, box.minimum.z, box.maximum.x - 1, box.maximum.y - 2, box.maximum.z - 3})
        EXPECT_NEAR(number, 0.0, 1e-4);
}

}  // namespace
}  // namespace bendy::bounds_test
