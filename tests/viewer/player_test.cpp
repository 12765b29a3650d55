#include "players.h"

#include <bendy/runtime/blend.h>

#include "overlay.h"
#include "viewer/example_model.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <cmath>

namespace bendy::viewer::player_test {
namespace {

class PlayerTest : public testing::Test {
protected:
    test::ExampleModel model{test::example("mannequin.glb")};
    Player player{*model};
};

TEST_F(PlayerTest, PlaysRoundAndRound) {
    const double length = player.length();
    player.step(0.25 * length);
    EXPECT_NEAR(player.phase, 0.25f, 1e-5f);
    player.step(0.9 * length);
    EXPECT_NEAR(player.phase, 0.15f, 1e-5f);
    player.is_playing = false;
    player.step(0.5);
    EXPECT_NEAR(player.phase, 0.15f, 1e-5f);
}

TEST_F(PlayerTest, PosesAsTheRuntimeDoes) {
    player.clip = 1;
    player.phase = 0.5f;
    player.update();
    const Clip& clip = model->clips()[1];
    Pose expected(*model);
    EXPECT_TRUE(sample(expected, &clip, clip.start + 0.5f * (clip.end - clip.start)));
    for (std::uint32_t joint = 0; joint < expected.model().joints().size(); ++joint)
        EXPECT_EQ(player.pose().local(joint).rotation, expected.local(joint).rotation);
}

TEST_F(PlayerTest, BlendIsOneClipAtEachEndAndBetweenThemInTheMiddle) {
    Pose a(*model);
    Pose b(*model);
    EXPECT_TRUE(sample(a, &model->clips()[0], 0.2f));
    EXPECT_TRUE(sample(b, &model->clips()[1], 0.4f));
    Pose at_a = a;
    EXPECT_TRUE(blend(at_a, b, 0.0f));
    Pose at_b = a;
    EXPECT_TRUE(blend(at_b, b, 1.0f));
    Pose middle = a;
    EXPECT_TRUE(blend(middle, b, 0.5f));
    const auto closeness = [](const glm::quat& p, const glm::quat& q) { return std::abs(glm::dot(p, q)); };
    for (std::uint32_t j = 0; j < a.model().joints().size(); ++j) {
        EXPECT_NEAR(closeness(at_a.local(j).rotation, a.local(j).rotation), 1.0f, 1e-5f);
        EXPECT_NEAR(closeness(at_b.local(j).rotation, b.local(j).rotation), 1.0f, 1e-5f);
        EXPECT_NEAR(closeness(middle.local(j).rotation, a.local(j).rotation),
                    closeness(middle.local(j).rotation, b.local(j).rotation), 1e-5f);
        EXPECT_LT(glm::length(middle.local(j).translation - 0.5f * (a.local(j).translation + b.local(j).translation)),
                  1e-5f);
    }
}

TEST_F(PlayerTest, AChainThatIsOnReaches) {
    const Chain* arm = model->chain("IK_LeftArm");
    ASSERT_NE(arm, nullptr);
    player.is_playing = false;
    player.clip = kNone;
    player.chains[static_cast<std::size_t>(arm - model->chains().data())] = {true, {0.3f, 1.2f, 0.4f}};
    player.update();
    EXPECT_LT(glm::length(tip_of(*arm, player.pose()) - glm::vec3(0.3f, 1.2f, 0.4f)), 2e-3f);
}

}  // namespace
}  // namespace bendy::viewer::player_test
