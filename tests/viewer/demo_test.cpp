#include "players.h"

#include "viewer/example_model.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace bendy::viewer::demo_test {
namespace {

constexpr double kFrame = 1.0 / 60.0;
constexpr double kLegal = 1e-5;  // radians

class DemoTest : public testing::Test {
protected:
    void run(double seconds) {
        for (double at = 0.0; at < seconds; at += kFrame) {
            demo.step(kFrame);
            ASSERT_LE(demo.violation(), kLegal);
        }
    }
    [[nodiscard]] float distance() { return glm::length(demo.tip() - demo.state().target); }

    test::ExampleModel model{test::example("tentacle.glb")};
    Demo demo{*model};
};

TEST_F(DemoTest, PlaysItsAnimationAtFirstAndPStopsIt) {
    const glm::vec3 before = demo.tip();
    run(0.3);
    EXPECT_GT(glm::length(demo.tip() - before), 1e-3f);
    EXPECT_NEAR(demo.state().time, 0.3, 0.03);
    demo.press(DemoKey::pause);
    EXPECT_TRUE(demo.state().paused);
    const glm::vec3 stopped = demo.tip();
    run(0.3);
    EXPECT_EQ(demo.tip(), stopped);
    demo.press(DemoKey::pause);
    run(0.1);
    EXPECT_NE(demo.tip(), stopped);
}

TEST_F(DemoTest, TogglesSwitchOnAndOff) {
    struct Toggle {
        DemoKey key;
        bool DemoState::*flag;
    };
    for (const auto& [key, flag] :
         {Toggle{DemoKey::bones, &DemoState::bones}, Toggle{DemoKey::wireframe, &DemoState::wireframe},
          Toggle{DemoKey::turntable, &DemoState::turntable}, Toggle{DemoKey::help, &DemoState::help},
          Toggle{DemoKey::pause, &DemoState::paused}, Toggle{DemoKey::forward, &DemoState::forward},
          Toggle{DemoKey::inverse, &DemoState::inverse}}) {
        const bool before = demo.state().*flag;
        demo.press(key);
        EXPECT_EQ(demo.state().*flag, !before);
        demo.press(key);
        EXPECT_EQ(demo.state().*flag, before);
    }
}

TEST_F(DemoTest, EscapeQuits) {
    EXPECT_FALSE(demo.state().quits);
    demo.press(DemoKey::quit);
    EXPECT_TRUE(demo.state().quits);
}

TEST_F(DemoTest, TurntableTurnsOnlyWhileItIsOn) {
    run(0.2);
    EXPECT_EQ(demo.state().angle, 0.0);
    demo.press(DemoKey::turntable);
    run(0.5);
    EXPECT_NEAR(demo.state().angle, 0.4, 0.03);
}

TEST_F(DemoTest, ForwardAndInverseExcludeEachOther) {
    demo.press(DemoKey::forward);
    demo.press(DemoKey::inverse);
    EXPECT_FALSE(demo.state().forward);
    EXPECT_TRUE(demo.state().inverse);
    demo.press(DemoKey::forward);
    EXPECT_TRUE(demo.state().forward);
    EXPECT_FALSE(demo.state().inverse);
}

TEST_F(DemoTest, KeysMoveTheTentacleByHand) {
    demo.press(DemoKey::forward);
    run(0.5);
    const glm::vec3 straight = demo.tip();
    demo.hold(DemoKey::right, 0.5);
    run(0.1);
    EXPECT_GT(demo.tip().x, straight.x + 0.02f);
    demo.hold(DemoKey::left, 0.5);
    run(0.1);
    EXPECT_LT(glm::length(demo.tip() - straight), 1e-4f);
    demo.hold(DemoKey::left, 0.5);
    run(0.1);
    EXPECT_LT(demo.tip().x, straight.x - 0.02f);
    demo.hold(DemoKey::right, 0.5);
    demo.hold(DemoKey::up, 0.5);
    run(0.1);
    EXPECT_GT(demo.tip().z, straight.z + 0.02f);
}

TEST_F(DemoTest, ByHandTheLimitsHoldHoweverLongAKeyIsHeld) {
    demo.press(DemoKey::forward);
    for (const DemoKey key :
         {DemoKey::left, DemoKey::up, DemoKey::page_up, DemoKey::right, DemoKey::down, DemoKey::page_down}) {
        for (int k = 0; k < 20; ++k) {
            demo.hold(key, 0.25);
            run(0.05);
        }
    }
}

TEST_F(DemoTest, KeysMoveTheTarget) {
    demo.press(DemoKey::inverse);
    struct Way {
        DemoKey key;
        glm::vec3 direction;
    };
    // Out and back again: the target stays inside its ball.
    for (const auto& [key, direction] :
         {Way{DemoKey::left, {-1, 0, 0}}, Way{DemoKey::right, {1, 0, 0}}, Way{DemoKey::down, {0, -1, 0}},
          Way{DemoKey::up, {0, 1, 0}}, Way{DemoKey::page_down, {0, 0, 1}}, Way{DemoKey::page_up, {0, 0, -1}}}) {
        const glm::vec3 before = demo.state().target;
        demo.press(key);
        const glm::vec3 moved = demo.state().target - before;
        EXPECT_GT(glm::length(moved), 1e-3f);
        EXPECT_NEAR(glm::dot(glm::normalize(moved), direction), 1.0f, 1e-5f);
    }
}

TEST_F(DemoTest, KeysMoveTheTargetAsItIsSeen) {
    demo.press(DemoKey::inverse);
    for (const float yaw : {0.0f, 0.6f, 1.5707963f, 3.1415927f, -2.2f}) {
        for (const float pitch : {0.0f, 0.5f, -1.2f}) {
            const glm::vec3 eye(std::sin(yaw) * std::cos(pitch), std::sin(pitch), std::cos(yaw) * std::cos(pitch));
            const glm::vec3 right(std::cos(yaw), 0.0f, -std::sin(yaw));
            const glm::vec3 up = glm::cross(eye, right);
            demo.look_along(right, up);
            struct Way {
                DemoKey key;
                glm::vec3 direction;
            };
            for (const auto& [key, direction] :
                 {Way{DemoKey::left, -right}, Way{DemoKey::right, right}, Way{DemoKey::down, -up}, Way{DemoKey::up, up},
                  Way{DemoKey::page_down, eye}, Way{DemoKey::page_up, -eye}}) {
                demo.drag_target({0.1f, 0.9f, 0.1f});
                const glm::vec3 before = demo.state().target;
                demo.press(key);
                const glm::vec3 moved = demo.state().target - before;
                EXPECT_GT(glm::length(moved), 1e-3f);
                EXPECT_NEAR(glm::dot(glm::normalize(moved), direction), 1.0f, 1e-4f) << yaw << ' ' << pitch;
            }
        }
    }
}

TEST_F(DemoTest, KeysBendTheTentacleToTheSidesThatAreSeen) {
    demo.press(DemoKey::forward);
    run(0.5);
    const glm::vec3 straight = demo.tip();
    for (const float yaw : {0.0f, 0.7f, 1.5707963f, 3.1415927f}) {
        const glm::vec3 right(std::cos(yaw), 0.0f, -std::sin(yaw));
        demo.look_along(right, {0.0f, 1.0f, 0.0f});
        demo.hold(DemoKey::right, 0.5);
        run(0.05);
        EXPECT_GT(glm::dot(demo.tip() - straight, right), 0.02f) << yaw;
        demo.hold(DemoKey::left, 0.5);
        run(0.05);
        EXPECT_LT(glm::length(demo.tip() - straight), 1e-4f) << yaw;
    }
}

TEST_F(DemoTest, TabGoesThroughTheJointsAndBackToAll) {
    EXPECT_EQ(demo.state().joint, kNone);
    EXPECT_EQ(demo.links().size(), demo.chain().links);
    EXPECT_EQ(demo.links().front(), demo.chain().record.start);
    EXPECT_EQ(demo.links().back(), demo.chain().record.effector);
    for (const std::uint32_t joint : demo.links()) {
        demo.press(DemoKey::next_joint);
        EXPECT_EQ(demo.state().joint, joint);
        EXPECT_TRUE(demo.state().forward);  // it is of no use elsewhere
    }
    demo.press(DemoKey::next_joint);
    EXPECT_EQ(demo.state().joint, kNone);
    demo.press(DemoKey::previous_joint);
    EXPECT_EQ(demo.state().joint, demo.links().back());
    demo.press(DemoKey::inverse);
    demo.press(DemoKey::previous_joint);
    EXPECT_TRUE(demo.state().forward);
    EXPECT_FALSE(demo.state().inverse);
    EXPECT_EQ(demo.state().joint, demo.links()[demo.links().size() - 2]);
}

TEST_F(DemoTest, KeysBendOneJointAndWhatHangsOnIt) {
    demo.press(DemoKey::forward);
    run(0.5);
    for (std::size_t link = 0; link < demo.links().size(); ++link) {
        demo.press(DemoKey::next_joint);
        const std::uint32_t joint = demo.links()[link];
        for (const auto& [key, back] : {std::pair(DemoKey::left, DemoKey::right), std::pair(DemoKey::up, DemoKey::down),
                                        std::pair(DemoKey::page_up, DemoKey::page_down)}) {
            const Pose before = demo.pose();
            const glm::vec3 tip = demo.tip();
            demo.hold(key, 0.05);
            run(0.02);
            for (std::uint32_t other = 0; other < before.model().joints().size(); ++other) {
                const float same = std::abs(glm::dot(before.local(other).rotation, demo.pose().local(other).rotation));
                if (other == joint) {
                    EXPECT_LT(same, 0.9999f) << link;
                } else {
                    EXPECT_EQ(demo.pose().local(other).rotation, before.local(other).rotation);
                }
            }
            if (key == DemoKey::left) {
                EXPECT_LT(demo.tip().x, tip.x - 1e-3f) << link;
            }
            demo.hold(back, 0.05);
            run(0.02);
            EXPECT_LT(glm::length(demo.tip() - tip), 1e-4f) << link;
        }
    }
}

TEST_F(DemoTest, OneJointBendsToTheSideThatIsSeen) {
    for (const float yaw : {0.0f, 0.6f, 1.5707963f, 3.1415927f, -1.1f}) {
        Demo own(*model);
        own.press(DemoKey::next_joint);
        own.step(0.5);
        const glm::vec3 right(std::cos(yaw), 0.0f, -std::sin(yaw));
        own.look_along(right, {0.0f, 1.0f, 0.0f});
        const glm::vec3 tip = own.tip();
        own.hold(DemoKey::right, 0.1);
        own.step(kFrame);
        EXPECT_GT(glm::dot(own.tip() - tip, right), 0.02f) << yaw;
    }
}

TEST_F(DemoTest, AKeyHeldAtALimitLeavesNothingToTakeBack) {
    demo.press(DemoKey::next_joint);
    run(0.5);
    demo.hold(DemoKey::right, 1.0);
    run(0.05);
    const glm::vec3 stopped = demo.tip();
    for (int k = 0; k < 10; ++k) demo.hold(DemoKey::right, 1.0);
    run(0.05);
    EXPECT_LT(glm::length(demo.tip() - stopped), 1e-4f);
    demo.hold(DemoKey::left, 0.05);
    run(0.05);
    EXPECT_GT(glm::length(demo.tip() - stopped), 0.02f);
}

TEST_F(DemoTest, OneJointAndAllBendTogetherInsideTheLimits) {
    for (int round = 0; round < 12; ++round) {
        demo.press(DemoKey::next_joint);
        for (const DemoKey key : {DemoKey::right, DemoKey::up, DemoKey::page_up, DemoKey::left}) {
            demo.hold(key, 0.7);
            run(0.05);
        }
    }
}

TEST_F(DemoTest, ArrowsDoNothingWithoutAMode) {
    demo.press(DemoKey::pause);
    const glm::vec3 target = demo.state().target;
    const glm::vec3 tip = demo.tip();
    demo.hold(DemoKey::right, 0.5);
    run(0.1);
    EXPECT_EQ(demo.state().target, target);
    EXPECT_EQ(demo.tip(), tip);
}

TEST_F(DemoTest, TheTargetPullsTheTipOverSeveralFrames) {
    const glm::vec3 before = demo.tip();
    demo.drag_target(before + glm::vec3(0.15f, -0.15f, 0.1f));
    EXPECT_TRUE(demo.state().inverse);
    const float far = distance();
    demo.step(kFrame);
    EXPECT_LT(distance(), far);
    EXPECT_GT(distance(), 0.3f * far);  // it does not snap
    run(6.0);
    EXPECT_LT(distance(), 0.1f * far);
}

TEST_F(DemoTest, TheTipArrivesWhereTheForceAloneGetsStuck) {
    demo.drag_target({0.5f, 1.5f, -0.1f});
    run(5.0);
    demo.drag_target({0.428f, 0.96f, -0.028f});
    run(6.0);
    EXPECT_LT(distance(), 0.02f);
}

TEST_F(DemoTest, PullingKeepsTheLimitsWhereverTheTargetGoes) {
    demo.press(DemoKey::inverse);
    const std::array<glm::vec3, 5> places{
        {{0.8f, 0.1f, 0.0f}, {-0.5f, -0.6f, 0.4f}, {0.0f, 0.02f, -0.1f}, {0.0f, 9.0f, 0.0f}, {0.02f, 0.3f, 0.02f}}};
    for (const glm::vec3& place : places) {
        demo.drag_target(place);
        run(1.0);
    }
}

TEST_F(DemoTest, FrameRateDoesNotMatterMuch) {
    Demo slow(*model);
    for (Demo* each : {&demo, &slow}) each->drag_target({0.5f, 1.4f, 0.3f});
    for (int k = 0; k < 120; ++k) demo.step(1.0 / 60.0);
    for (int k = 0; k < 40; ++k) slow.step(1.0 / 20.0);
    EXPECT_LT(glm::length(demo.tip() - slow.tip()), 0.02f);
}

TEST_F(DemoTest, ModesEaseIntoEachOther) {
    demo.drag_target({0.4f, 0.2f, 0.3f});
    run(2.0);
    const glm::vec3 pulled = demo.tip();
    demo.press(DemoKey::inverse);
    demo.step(kFrame);
    EXPECT_LT(glm::length(demo.tip() - pulled), 0.2f);  // the chain's limits are not quite the pose's
    run(1.0);
    EXPECT_GT(glm::length(demo.tip() - pulled), 0.2f);
}

}  // namespace
}  // namespace bendy::viewer::demo_test
