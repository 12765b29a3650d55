#include "pops.h"

#include <bendy/motion/retarget_clips.h>

#include "runtime/clip_model.h"
#include "runtime/human_model.h"

#include <gtest/gtest.h>
#include <glm/gtc/quaternion.hpp>

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace bendy::motion::pops_test {
namespace {

/// A rotation about X that is at 0 until half a second, and at `degrees` after that, with 1 ms in between.
test::TrackSpec jump(std::uint32_t joint, double degrees) {
    const double half = glm::radians(0.5 * degrees);
    test::TrackSpec track{TrackPath::rotation, joint, 4, {0.0f, 0.5f, 0.501f, 1.0f}, {}};
    for (const double angle : {0.0, 0.0, half, half})
        for (const double number : {std::sin(angle), 0.0, 0.0, std::cos(angle)})
            track.values.push_back(static_cast<float>(number));
    return track;
}

std::vector<JointPop> pops_of(double degrees, double of_source) {
    const test::HumanModel human(test::HumanSpec{});
    test::ModelSpec spec = human.spec;
    test::ClipSpec clip{"Jump"};
    clip.tracks.push_back(jump(human.joint("rightForeArm"), of_source));
    spec.more.push_back(test::clip_node(clip));
    const test::Owned model(test::build_file(spec));
    const test::TrackSpec made = jump(human.joint("leftForeArm"), degrees);
    UnpackedTrack track;
    track.path = made.path;
    track.joint = made.target;
    track.components = made.components;
    track.times = made.times;
    track.values = made.values;
    const std::vector<float> times{0.0f, 0.25f, 0.5f, 0.75f};
    return find_pops(*model, model->clips().front(), std::span(&track, 1), times);
}

TEST(Pops, AreWhatJumpsFartherThanTheSource) {
    const auto pops = pops_of(30.0, 10.0);
    ASSERT_EQ(pops.size(), 1u);
    EXPECT_NEAR(glm::degrees(pops.front().turn), 30.0, 0.01);
    EXPECT_NEAR(glm::degrees(pops.front().of_source), 10.0, 0.01);
    EXPECT_NEAR(pops.front().seconds, 0.5, 2.0 * kPopSeconds);
}

TEST(Pops, AreNoneWhereTheSourceJumpsToo) {
    EXPECT_TRUE(pops_of(30.0, 30.0 / kPopOfSource + 0.1).empty());
    EXPECT_TRUE(pops_of(kPopTurn - 0.1, 0.0).empty());
}

}  // namespace
}  // namespace bendy::motion::pops_test
