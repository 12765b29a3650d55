#include <bendy/runtime/pose.h>

#include <bendy/runtime/sample.h>

#include "pose/pose_state.h"
#include "runtime/build_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace bendy::pose_test {
namespace {

using test::Owned;

void expect_rest(const Pose& pose) {
    const auto joints = pose.model().joints();
    ASSERT_EQ(pose.local().size(), joints.size());
    for (std::size_t joint = 0; joint < joints.size(); ++joint) {
        EXPECT_EQ(pose.local()[joint].translation, joints[joint].rest.translation);
        EXPECT_EQ(pose.local()[joint].scale, joints[joint].rest.scale);
        EXPECT_TRUE(pose.local()[joint].rotation == joints[joint].rest.rotation);
    }
}

TEST(Pose, StartsAtRestWithItsMatrices) {
    const Owned model(test::sample_file());
    Pose pose(*model);
    EXPECT_EQ(pose.model(), *model);
    expect_rest(pose);
    EXPECT_FALSE(PoseState::of(pose).is_stale);
    ASSERT_EQ(pose.model_space().size(), 4u);
    EXPECT_EQ(glm::vec3(pose.model_space()[2][3]), glm::vec3(0, 1.75f, 0));
    EXPECT_EQ(std::vector<float>(pose.morph_weights().begin(), pose.morph_weights().end()),
              (std::vector{0.125f, 0.0f}));
}

TEST(Pose, GoesBackToRest) {
    const Owned model(test::sample_file());
    Pose pose(*model);
    for (JointTransform& local : pose.change_local()) local = {glm::quat(0, 1, 0, 0), {7, 7, 7}, {2, 2, 2}};
    for (float& weight : pose.change_morph_weights()) weight = 3.0f;
    (void)pose.model_space();
    pose.set_rest();
    expect_rest(pose);
    EXPECT_TRUE(PoseState::of(pose).is_stale);
    EXPECT_EQ(pose.morph_weights()[0], 0.125f);
    EXPECT_EQ(pose.morph_weights()[1], 0.0f);
}

TEST(Pose, IsStaleWhenAskedForItsJointsToWrite) {
    const Owned model(test::sample_file());
    Pose pose(*model);
    static_cast<void>(pose.local());
    static_cast<void>(pose.change_morph_weights());  // no matrix follows from these
    EXPECT_FALSE(PoseState::of(pose).is_stale);
    static_cast<void>(pose.change_local());
    EXPECT_TRUE(PoseState::of(pose).is_stale);
}

TEST(Pose, MatricesFollowTheTransformsAsTheyAre) {
    const Owned model(test::sample_file());
    Pose pose(*model);
    pose.change_local()[1].translation = {0, 0, 4};
    EXPECT_EQ(glm::vec3(pose.model_space()[2][3]), glm::vec3(0, 1.25f, 4));
    pose.set_rest();
    EXPECT_EQ(glm::vec3(pose.model_space()[2][3]), glm::vec3(0, 1.75f, 0));
}

TEST(Pose, HasRoomForNothing) {
    const Owned model(test::build_file({}));
    Pose pose(*model);
    EXPECT_TRUE(pose.local().empty());
    EXPECT_TRUE(pose.morph_weights().empty());
    EXPECT_TRUE(pose.model_space().empty());
}

TEST(Pose, CopiesAreTheirOwn) {
    const Owned model(test::sample_file());
    Pose pose(*model);
    Pose copy = pose;
    copy.change_local()[0].translation = {9, 9, 9};
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
            EXPECT_FALSE(PoseState::of(pose).is_stale);
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
