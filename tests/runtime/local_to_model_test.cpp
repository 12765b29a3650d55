
#include <bendy/runtime/kernels.h>
#include <bendy/runtime/skin.h>

#include "pose/pose_state.h"
#include "runtime/build_model.h"
#include "runtime/local_joints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace bendy::local_to_model_test {
namespace {

using test::Owned;

glm::vec3 place(Pose& pose, std::size_t joint) {
    return {pose.model_space()[joint][3]};
}

TEST(LocalToModel, AJointStandsInItsParentsSpace) {
    test::ModelSpec spec;
    spec.joints = {{kNone, test::moved(1, 0, 0), {}, "root"}, {0, test::turned(90, 2), {}, "turned"},  // x becomes y
                   {1, test::scaled(2, 3, 4), {}, "scaled"},  {2, test::moved(1, 1, 1), {}, "tip"},
                   {0, test::moved(0, 5, 0), {}, "sibling"},  {kNone, test::moved(0, 0, 7), {}, "other root"}};
    const Owned model(test::build_file(spec));
    Pose pose(*model);
    EXPECT_EQ(place(pose, 0), glm::vec3(1, 0, 0));
    EXPECT_EQ(place(pose, 1), glm::vec3(1, 0, 0));
    // (1, 1, 1) scaled: (2, 3, 4); turned: (-3, 2, 4); moved: (-2, 2, 4).
    EXPECT_NEAR(place(pose, 3).x, -2, 1e-6);
    EXPECT_NEAR(place(pose, 3).y, 2, 1e-6);
    EXPECT_NEAR(place(pose, 3).z, 4, 1e-6);
    EXPECT_EQ(place(pose, 4), glm::vec3(1, 5, 0));
    EXPECT_EQ(place(pose, 5), glm::vec3(0, 0, 7));
}

TEST(LocalToModel, ShearOfTheParentReachesTheChild) {
    test::ModelSpec spec;
    spec.joints.resize(2);
    spec.joints[0].rest.shear = {1, 2, 3};
    spec.joints[1].parent = 0;
    spec.joints[1].rest = test::moved(0, 10, 100);
    const Owned model(test::build_file(spec));
    Pose pose(*model);
    EXPECT_EQ(place(pose, 1), glm::vec3(1 * 10 + 2 * 100, 10 + 3 * 100, 100));
}

TEST(LocalToModel, FollowsWhatWasChanged) {
    const Owned model(test::sample_file());
    Pose pose(*model);
    EXPECT_TRUE(PoseState::of(pose).stale.is_empty());
    EXPECT_EQ(place(pose, 2), glm::vec3(0, 1.75f, 0));
    test::local_of(pose, 1)->translation = {0, 0, 4};
    EXPECT_FALSE(PoseState::of(pose).stale.is_empty());
    EXPECT_EQ(place(pose, 2), glm::vec3(0, 1.25f, 4));  // as soon as it is asked for
    EXPECT_TRUE(PoseState::of(pose).stale.is_empty());
    EXPECT_EQ(place(pose, 3), glm::vec3(0, 0.75f, 0));  // its parent is joint 0
}

constexpr std::uint32_t kDeep = 10'000;

TEST(LocalToModel, TenThousandLevelsOfTurnsAreExact) {
    const Owned model(test::rope_file(kDeep));
    Pose pose(*model);
    test::change_locals(pose, [&](JointTransform& local) {
        local.rotation =
            glm::quat(0.5f, 0.5f, 0.5f, 0.5f);  // a third of a turn: x to y, y to z, z to x; exact in binary
        local.translation = {1, 2, 4};
    });
    (void)pose.model_space();
    // Each step turns the axes on, so three steps together go 1 + 2 + 4 along each.
    const std::array<glm::vec3, 3> steps{glm::vec3(1, 2, 4), glm::vec3(4, 1, 2), glm::vec3(2, 4, 1)};
    glm::vec3 expected(0.0f);
    for (std::uint32_t joint = 0; joint < kDeep; ++joint) {
        expected += steps[joint % 3];
        ASSERT_EQ(place(pose, joint), expected) << joint;
    }
}

TEST(LocalToModel, RoundingDoesNotAddUpAlongAChain) {
    const Owned model(test::rope_file(kDeep));
    Pose pose(*model);
    test::change_locals(pose, [&](JointTransform& local) {
        local.rotation = glm::quat(0.5f, 0.5f, 0.5f, 0.5f);
        local.translation = glm::vec3(0.1f);  // along the axis that the turns keep
    });
    (void)pose.model_space();
    const double expected = kDeep * double{0.1f};
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(place(pose, kDeep - 1)[c], expected, 1e-4);
}

TEST(LocalToModel, ALeafOfADeepChainComesBackToItsParent) {
    const Owned model(test::rope_file(kDeep));
    Pose pose(*model);
    for (std::uint32_t joint = 0; joint < kDeep; ++joint)
        test::local_of(pose, joint)->translation.x = joint < kDeep / 2 ? 0.7f : -0.7f;
    (void)pose.model_space();
    EXPECT_NEAR(place(pose, kDeep / 2 - 1).x, kDeep / 2 * double{0.7f}, 1e-3);
    EXPECT_NEAR(place(pose, kDeep - 1).x, 0.0, 1e-6);
}

/// Joints at random, each under one before it or under none, turned, scaled and mirrored.
test::ModelSpec random_joints(std::uint32_t count, float shear) {
    std::mt19937 random(count);
    std::uniform_real_distribution<float> number(-1.0f, 1.0f);
    test::ModelSpec spec;
    std::vector<std::uint32_t> open;  // pre-order: a parent is the last joint or above it
    for (std::uint32_t joint = 0; joint < count; ++joint) {
        while (!open.empty() && random() % 3 == 0) open.pop_back();
        test::JointSpec made;
        made.parent = open.empty() ? kNone : open.back();
        const glm::quat q = glm::normalize(glm::quat(number(random), number(random), number(random), 0.5f));
        made.rest.rotation = {q.x, q.y, q.z, q.w};
        made.rest.translation = {number(random), 1000.0f * number(random), number(random)};
        made.rest.scale = {1.0f + 0.1f * number(random), -1.0f + 0.1f * number(random), 1.0f};
        made.rest.shear = {shear, 0.0f, -shear};
        spec.joints.push_back(made);
        open.push_back(joint);
    }
    return spec;
}

/// What goes into a joint's matrix, summed up without signs, and how many products deep.
struct Magnitude {
    glm::dmat4 sums;
    int depth = 0;
};

std::vector<Magnitude> magnitudes_of(const Model& model) {
    std::vector<Magnitude> magnitudes;
    for (const Joint& joint : model.joints()) {
        glm::dmat4 local = to_matrix(joint.rest, joint.shear);
        for (int c = 0; c < 4; ++c) local[c] = glm::abs(local[c]);
        for (int c = 0; c < 3; ++c) local[c] += glm::dvec4(glm::dvec3(std::abs(joint.rest.scale[c])), 0.0);
        const bool is_root = joint.parent == kNone;
        magnitudes.push_back({is_root ? local : magnitudes[joint.parent].sums * local,
                              is_root ? 1 : magnitudes[joint.parent].depth + 1});
    }
    return magnitudes;
}

/// The rest pose's matrices in model space.
std::vector<glm::dmat4> in_doubles(const Model& model) {
    std::vector<glm::dmat4> matrices;
    for (const Joint& joint : model.joints()) {
        const glm::dmat4 local = to_matrix(joint.rest, joint.shear);
        matrices.push_back(joint.parent == kNone ? local : matrices[joint.parent] * local);
    }
    return matrices;
}

TEST(LocalToModel, AllKernelsAgreeWithDoubles) {
    const Kernel before = kernel();
    for (const float shear : {0.0f, 0.25f}) {
        for (const std::uint32_t count : {1u, 2u, 3u, 4u, 5u, 7u, 8u, 9u, 50u, 203u}) {
            const Owned model(test::build_file(random_joints(count, shear)));
            EXPECT_EQ(model->is_sheared(), shear != 0.0f);
            const std::vector<Magnitude> magnitudes = magnitudes_of(*model);
            const std::vector<glm::dmat4> expected = in_doubles(*model);
            for (const Kernel each : kernels()) {
                ASSERT_TRUE(set_kernel(each));
                Pose found(*model);
                for (std::uint32_t joint = 0; joint < count; ++joint) {
                    const Magnitude& magnitude = magnitudes[joint];
                    for (int c = 0; c < 4; ++c) {
                        for (int r = 0; r < 4; ++r) {
                            // Three units in the last place for each product on the way.
                            EXPECT_NEAR(found.model_space()[joint][c][r], expected[joint][c][r],
                                        3.0 * magnitude.depth * 0x1p-24 * magnitude.sums[c][r])
                                << kernel_name(each) << ", joint " << joint;
                        }
                    }
                }
            }
        }
    }
    EXPECT_TRUE(set_kernel(before));
}

TEST(LocalToModel, LargeTranslationsCancelInThePaletteWithAllKernels) {
    // A character a thousand kilometres from its origin, its bind matrices as exact as floats are.
    test::ModelSpec spec;
    spec.joints.resize(2);
    spec.joints[0].rest = test::moved(1e6f, 0, -2e6f);
    spec.joints[1].parent = 0;
    spec.joints[1].rest = test::turned(30, 2);
    glm::mat4 bind(1.0f);
    bind[3] = glm::vec4(-1e6f, 0.0f, 2e6f, 1.0f);
    spec.meshes.resize(1);
    spec.meshes[0].positions = {{0.125f, 0.25f, 0.5f}};
    spec.meshes[0].more = {test::make_leaf(FourCC("BONE"), test::stream_payload<std::uint8_t>(2, {0, 1})),
                           test::make_leaf(FourCC("WGHT"), test::stream_payload<float>(2, {1.0f, 0.0f})),
                           test::palette_leaf({0, 1}, {bind, bind})};
    const Owned model(test::build_file(spec));
    const Kernel before = kernel();
    for (const Kernel each : kernels()) {
        ASSERT_TRUE(set_kernel(each));
        Pose pose(*model);
        std::vector<glm::vec3> positions(1);
        ASSERT_TRUE(skin(pose, {.out = {positions, {}, {}}}));
        EXPECT_EQ(positions[0], glm::vec3(0.125f, 0.25f, 0.5f)) << kernel_name(each);
    }
    EXPECT_TRUE(set_kernel(before));
}

TEST(LocalToModel, BonesThatAreNotFiniteDoNotHarmVerticesWithoutThem) {
    test::ModelSpec spec;
    spec.joints.resize(2);
    glm::mat4 bad(1.0f);
    bad[1][1] = std::numeric_limits<float>::infinity();
    spec.meshes.resize(1);
    std::vector<std::uint8_t> bones;
    std::vector<float> weights;
    for (int v = 0; v < 21; ++v) {
        spec.meshes[0].positions.emplace_back(1, 2, v);
        bones.insert(bones.end(), {0, 1});
        weights.insert(weights.end(), {1.0f, 0.0f});
    }
    spec.meshes[0].more = {test::make_leaf(FourCC("BONE"), test::stream_payload<std::uint8_t>(2, bones)),
                           test::make_leaf(FourCC("WGHT"), test::stream_payload<float>(2, weights)),
                           test::palette_leaf({0, 1}, {glm::mat4(1.0f), bad})};
    const Owned model(test::build_file(spec));
    const Kernel before = kernel();
    for (const Kernel each : kernels()) {
        ASSERT_TRUE(set_kernel(each));
        Pose pose(*model);
        std::vector<glm::vec3> positions(21);
        ASSERT_TRUE(skin(pose, {.out = {positions, {}, {}}}));
        EXPECT_EQ(positions, spec.meshes[0].positions) << kernel_name(each);
    }
    EXPECT_TRUE(set_kernel(before));
}

}  // namespace
}  // namespace bendy::local_to_model_test
