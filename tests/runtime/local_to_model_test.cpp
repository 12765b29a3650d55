#include <bendy/runtime/local_to_model.h>

#include "runtime/build_model.h"

#include <gtest/gtest.h>

namespace bendy {
namespace {

using test::Owned;

glm::vec3 place(const Pose& pose, std::size_t joint) {
    return {pose.model_space()[joint][3]};
}

TEST(LocalToModel, AJointStandsInItsParentsSpace) {
    test::ModelSpec spec;
    spec.joints = {{kNone, test::moved(1, 0, 0), {}, "root"}, {0, test::turned(90, 2), {}, "turned"},  // x becomes y
                   {1, test::scaled(2, 3, 4), {}, "scaled"},  {2, test::moved(1, 1, 1), {}, "tip"},
                   {0, test::moved(0, 5, 0), {}, "sibling"},  {kNone, test::moved(0, 0, 7), {}, "other root"}};
    const Owned model(test::build_file(spec));
    const Pose pose(*model);
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
    const Pose pose(*model);
    EXPECT_EQ(place(pose, 1), glm::vec3(1 * 10 + 2 * 100, 10 + 3 * 100, 100));
}

TEST(LocalToModel, FollowsWhatWasChanged) {
    const Owned model(test::sample_file());
    Pose pose(*model);
    EXPECT_FALSE(pose.is_stale());
    EXPECT_EQ(place(pose, 2), glm::vec3(0, 1.75f, 0));
    pose.change_local()[1].translation = {0, 0, 4};
    EXPECT_TRUE(pose.is_stale());
    EXPECT_EQ(place(pose, 2), glm::vec3(0, 1.75f, 0));  // not before it is asked for
    local_to_model(pose);
    EXPECT_FALSE(pose.is_stale());
    EXPECT_EQ(place(pose, 2), glm::vec3(0, 1.25f, 4));
    EXPECT_EQ(place(pose, 3), glm::vec3(0, 0.75f, 0));  // its parent is joint 0
}

constexpr std::uint32_t kDeep = 10'000;

TEST(LocalToModel, TenThousandLevelsOfTurnsAreExact) {
    const Owned model(test::rope_file(kDeep));
    Pose pose(*model);
    for (JointTransform& local : pose.change_local()) {
        local.rotation =
            glm::quat(0.5f, 0.5f, 0.5f, 0.5f);  // a third of a turn: x to y, y to z, z to x; exact in binary
        local.translation = {1, 2, 4};
    }
    local_to_model(pose);
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
    for (JointTransform& local : pose.change_local()) {
        local.rotation = glm::quat(0.5f, 0.5f, 0.5f, 0.5f);
        local.translation = glm::vec3(0.1f);  // along the axis that the turns keep
    }
    local_to_model(pose);
    const double expected = kDeep * double{0.1f};
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(place(pose, kDeep - 1)[c], expected, 1e-4);
}

TEST(LocalToModel, ALeafOfADeepChainComesBackToItsParent) {
    const Owned model(test::rope_file(kDeep));
    Pose pose(*model);
    const auto local = pose.change_local();
    for (std::uint32_t joint = 0; joint < kDeep; ++joint) local[joint].translation.x = joint < kDeep / 2 ? 0.7f : -0.7f;
    local_to_model(pose);
    EXPECT_NEAR(place(pose, kDeep / 2 - 1).x, kDeep / 2 * double{0.7f}, 1e-3);
    EXPECT_NEAR(place(pose, kDeep - 1).x, 0.0, 1e-6);
}

}  // namespace
}  // namespace bendy
