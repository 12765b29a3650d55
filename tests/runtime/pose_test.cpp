#include <bendy/runtime/pose.h>

#include <bendy/runtime/blend.h>
#include <bendy/runtime/kernels.h>
#include <bendy/runtime/sample.h>

#include "pose/pose_state.h"
#include "runtime/build_model.h"
#include "runtime/local_joints.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <random>
#include <vector>

namespace bendy::pose_test {
namespace {

using test::Owned;

void expect_rest(const Pose& pose) {
    const auto joints = pose.model().joints();
    for (std::uint32_t joint = 0; joint < joints.size(); ++joint) {
        EXPECT_EQ(pose.local(joint).translation, joints[joint].rest.translation);
        EXPECT_EQ(pose.local(joint).scale, joints[joint].rest.scale);
        EXPECT_TRUE(pose.local(joint).rotation == joints[joint].rest.rotation);
    }
}

TEST(Pose, StartsAtRestWithItsMatrices) {
    const Owned model(test::sample_file());
    Pose pose(*model);
    EXPECT_EQ(pose.model(), *model);
    expect_rest(pose);
    EXPECT_TRUE(PoseState::of(pose).stale.is_empty());
    ASSERT_EQ(pose.model_space().size(), 4u);
    EXPECT_EQ(glm::vec3(pose.model_space()[2][3]), glm::vec3(0, 1.75f, 0));
    EXPECT_EQ(std::vector<float>(pose.morph_weights().begin(), pose.morph_weights().end()),
              (std::vector{0.125f, 0.0f}));
}

TEST(Pose, GoesBackToRest) {
    const Owned model(test::sample_file());
    Pose pose(*model);
    test::change_locals(pose, [](JointTransform& local) { local = {glm::quat(0, 1, 0, 0), {7, 7, 7}, {2, 2, 2}}; });
    for (float& weight : pose.change_morph_weights()) weight = 3.0f;
    (void)pose.model_space();
    pose.set_rest();
    expect_rest(pose);
    EXPECT_FALSE(PoseState::of(pose).stale.is_empty());
    EXPECT_EQ(pose.morph_weights()[0], 0.125f);
    EXPECT_EQ(pose.morph_weights()[1], 0.0f);
}

TEST(Pose, IsStaleWhenAJointIsSet) {
    const Owned model(test::sample_file());
    Pose pose(*model);
    static_cast<void>(pose.local(0));
    static_cast<void>(pose.change_morph_weights());  // no matrix follows from these
    EXPECT_TRUE(PoseState::of(pose).stale.is_empty());
    pose.set_local(0, pose.local(0));
    EXPECT_FALSE(PoseState::of(pose).stale.is_empty());
}

TEST(Pose, HasItsJointsInBlocksOfEightPaddedWithTheIdentity) {
    test::ModelSpec spec;
    spec.joints.resize(11);
    const Owned model(test::build_file(spec));
    Pose pose(*model);
    Pose other(*model);
    for (std::uint32_t joint = 0; joint < 11; ++joint) {
        const auto number = static_cast<float>(joint);
        const JointTransform transform{glm::normalize(glm::quat(1, 2, number, 4)), {number, 5, 6}, {7, 8, -number}};
        pose.set_local(joint, transform);
        EXPECT_EQ(pose.local(joint).rotation, transform.rotation);
        EXPECT_EQ(pose.local(joint).translation, transform.translation);
        EXPECT_EQ(pose.local(joint).scale, transform.scale);
    }
    const Kernel before = kernel();
    for (const Kernel each : kernels()) {
        ASSERT_TRUE(set_kernel(each));
        EXPECT_TRUE(blend(pose, other, -3.0f, {}));
        EXPECT_TRUE(add(pose, other, 1e6f, {}));
        ASSERT_EQ(pose.local_blocks().size(), 2u);
        for (std::uint32_t joint = 0; joint < 11; ++joint)
            EXPECT_EQ(pose.local_blocks()[joint / 8].joint(joint % 8).scale, pose.local(joint).scale);
        const JointTransform identity;
        for (std::uint32_t lane = 3; lane < JointBlock::kJoints; ++lane) {
            const JointTransform outside = pose.local_blocks()[1].joint(lane);
            EXPECT_EQ(outside.rotation, identity.rotation) << kernel_name(each);
            EXPECT_EQ(outside.translation, identity.translation);
            EXPECT_EQ(outside.scale, identity.scale);
        }
    }
    EXPECT_TRUE(set_kernel(before));
}

TEST(Pose, MatricesFollowTheTransformsAsTheyAre) {
    const Owned model(test::sample_file());
    Pose pose(*model);
    test::local_of(pose, 1)->translation = {0, 0, 4};
    EXPECT_EQ(glm::vec3(pose.model_space()[2][3]), glm::vec3(0, 1.25f, 4));
    pose.set_rest();
    EXPECT_EQ(glm::vec3(pose.model_space()[2][3]), glm::vec3(0, 1.75f, 0));
}

TEST(Pose, ChangesOfSomeJointsGiveTheMatricesOfAWholePose) {
    test::ModelSpec spec;
    std::mt19937 random(3);
    spec.joints.resize(61);
    for (std::uint32_t k = 1; k < 61; ++k) {  // as in a file: a joint follows its parent or that one's other children
        std::uint32_t parent = k - 1;
        for (auto up = random() % 4; up > 0 && parent != 0; --up) parent = spec.joints[parent].parent;
        spec.joints[k].parent = parent;
    }
    const Owned model(test::build_file(spec));
    const Kernel before = kernel();
    std::uniform_real_distribution<float> number(-1.0f, 1.0f);
    for (const Kernel each : kernels()) {
        ASSERT_TRUE(set_kernel(each));
        Pose pose(*model);
        for (int turn = 0; turn < 300; ++turn) {
            for (auto count = random() % 12; count > 0; --count) {
                const std::uint32_t joint = random() % 5 == 0 ? 0 : static_cast<std::uint32_t>(random() % 61);
                JointTransform transform;
                transform.rotation = glm::normalize(glm::quat(1, number(random), number(random), number(random)));
                transform.translation = {number(random), number(random), number(random)};
                pose.set_local(joint, transform);
            }
            Pose whole(*model);
            std::copy_n(pose.local_blocks().begin(), pose.local_blocks().size(), whole.change_local_blocks().begin());
            const auto expected = whole.model_space();
            ASSERT_EQ(std::memcmp(pose.model_space().data(), expected.data(), expected.size_bytes()), 0)
                << kernel_name(each) << ", turn " << turn;
        }
    }
    EXPECT_TRUE(set_kernel(before));
}

TEST(Pose, HasRoomForNothing) {
    const Owned model(test::build_file({}));
    Pose pose(*model);
    EXPECT_TRUE(pose.local_blocks().empty());
    EXPECT_TRUE(pose.morph_weights().empty());
    EXPECT_TRUE(pose.model_space().empty());
}

TEST(Pose, CopiesAreTheirOwn) {
    const Owned model(test::sample_file());
    Pose pose(*model);
    Pose copy = pose;
    test::local_of(copy, 0)->translation = {9, 9, 9};
    EXPECT_EQ(glm::vec3(pose.model_space()[0][3]), glm::vec3(0, 1, 0));
    EXPECT_EQ(glm::vec3(copy.model_space()[0][3]), glm::vec3(9, 9, 9));
}

TEST(Pose, PalettesAreThoseOfTheirMeshesInThePoseAsItIs) {
    const Owned model(test::sample_file());
    Pose pose(*model);
    for (const float seconds : {0.6f, 0.9f}) {
        ASSERT_TRUE(sample(pose, model->clip("run"), seconds));
        std::uint32_t entries = 0;
        for (const std::uint32_t number : {0u, 1u, 0u}) {
            const Mesh& mesh = model->meshes()[number];
            const std::span<const PaletteMatrix> palette = pose.palette(number);
            EXPECT_TRUE(PoseState::of(pose).stale.is_empty());
            ASSERT_EQ(palette.size(), mesh.palette.joints.size());
            for (std::size_t entry = 0; entry < palette.size(); ++entry, ++entries) {
                const glm::dmat4 expected = glm::dmat4(pose.model_space()[mesh.palette.joints[entry]]) *
                                            glm::dmat4(mesh.palette.inverse_bind()[entry]);
                for (int row = 0; row < 3; ++row) {
                    for (int column = 0; column < 4; ++column)
                        EXPECT_NEAR(palette[entry].rows[row][column], expected[column][row], 1e-5);
                }
            }
        }
        EXPECT_GT(entries, 0u);
    }
}

}  // namespace
}  // namespace bendy::pose_test
