#include <bendy/runtime/crossfade.h>

#include <bendy/runtime/sample.h>

#include "runtime/build_model.h"
#include "runtime/clip_model.h"

#include <glm/vec3.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace bendy::crossfade_test {
namespace {

using test::Owned;

/// One joint; the clips "0", "1", ... hold it still at x = 1, 10, 100, ...
test::ModelSpec still_clips(int count) {
    test::ModelSpec spec;
    spec.joints.resize(1);
    float x = 1.0f;
    for (int k = 0; k < count; ++k, x *= 10.0f) {
        test::ClipSpec clip;
        clip.name = std::to_string(k);
        clip.end = 8.0f;
        clip.tracks.push_back({TrackPath::translation, 0, 3, {0.0f}, {x, 0.0f, 0.0f}});
        spec.more.push_back(test::clip_node(clip));
    }
    return spec;
}

TEST(Fade, GoesFromWhereItIs) {
    Fade fade(0.25f);
    EXPECT_EQ(fade.weight(), 0.25f);
    EXPECT_TRUE(fade.is_done());
    fade.to(1.0f, 2.0f, Easing::linear);
    EXPECT_EQ(fade.weight(), 0.25f);
    fade.advance(1.0);
    EXPECT_FLOAT_EQ(fade.weight(), 0.625f);
    fade.to(0.0f, 1.0f, Easing::smooth);
    EXPECT_FLOAT_EQ(fade.weight(), 0.625f);
    fade.advance(0.25);
    EXPECT_FLOAT_EQ(fade.weight(), 0.625f * (1.0f - (3.0f / 16.0f - 2.0f / 64.0f)));
    fade.advance(-1.0);
    fade.advance(9.0);
    EXPECT_EQ(fade.weight(), 0.0f);
    EXPECT_TRUE(fade.is_done());
    for (const float at_once : {0.0f, -1.0f, std::numeric_limits<float>::quiet_NaN()}) {
        Fade quick(1.0f);
        quick.to(0.5f, at_once);
        EXPECT_EQ(quick.weight(), 0.5f);
    }
}

TEST(Fade, EasingIsHeldToItsEnds) {
    for (const Easing easing : {Easing::linear, Easing::smooth}) {
        EXPECT_EQ(ease(easing, -3.0f), 0.0f);
        EXPECT_EQ(ease(easing, 0.0f), 0.0f);
        EXPECT_EQ(ease(easing, 0.5f), 0.5f);
        EXPECT_EQ(ease(easing, 1.0f), 1.0f);
        EXPECT_EQ(ease(easing, 7.0f), 1.0f);
        EXPECT_EQ(ease(easing, std::numeric_limits<float>::quiet_NaN()), 1.0f);
    }
    EXPECT_FLOAT_EQ(ease(Easing::smooth, 0.25f), 0.15625f);
}

TEST(Crossfade, WhatIsInterruptedGoesOnBeneath) {
    const Owned model(test::build_file(still_clips(3)));
    Pose pose(*model);
    Pose scratch(*model);
    Crossfade fade;
    EXPECT_FALSE(sample(pose, fade, scratch));
    EXPECT_EQ(fade.playback(), nullptr);
    fade.play(*model->clip("0"), 1.0f);
    ASSERT_TRUE(sample(pose, fade, scratch));
    EXPECT_FLOAT_EQ(pose.local(0).translation.x, 1.0f);

    fade.play(*model->clip("1"), 1.0f, Easing::linear);
    fade.advance(0.25);
    ASSERT_TRUE(sample(pose, fade, scratch));
    EXPECT_FLOAT_EQ(pose.local(0).translation.x, 0.75f * 1.0f + 0.25f * 10.0f);

    fade.play(*model->clip("2"), 0.5f, Easing::linear);
    ASSERT_TRUE(sample(pose, fade, scratch));
    EXPECT_FLOAT_EQ(pose.local(0).translation.x, 0.75f * 1.0f + 0.25f * 10.0f);  // nothing jumps
    fade.advance(0.25);
    ASSERT_TRUE(sample(pose, fade, scratch));
    const float below = 0.5f * 1.0f + 0.5f * 10.0f;
    EXPECT_FLOAT_EQ(pose.local(0).translation.x, 0.5f * below + 0.5f * 100.0f);
    ASSERT_EQ(fade.playing().size(), 3u);
    EXPECT_FLOAT_EQ(fade.playing()[0].share, 0.25f);
    EXPECT_FLOAT_EQ(fade.playing()[1].share, 0.25f);
    EXPECT_FLOAT_EQ(fade.playing()[2].share, 0.5f);
    EXPECT_FLOAT_EQ(fade.playing()[0].playback.seconds(), 0.5f);
    EXPECT_EQ(fade.playing()[2].played.first.to, 0.25);

    fade.advance(0.25);  // the newest covers all
    ASSERT_EQ(fade.playing().size(), 1u);
    EXPECT_EQ(fade.playing()[0].clip, model->clip("2"));
    EXPECT_EQ(fade.playing()[0].share, 1.0f);
    ASSERT_TRUE(sample(pose, fade, scratch));
    EXPECT_EQ(pose.local(0).translation.x, 100.0f);
    fade.playback()->set_speed(-1.0);
    fade.advance(0.25);
    EXPECT_EQ(fade.playback()->seconds(), 0.25f);
}

TEST(Crossfade, SharesAddUpAndTheOldestMakesRoom) {
    const Owned model(test::build_file(still_clips(6)));
    Pose pose(*model);
    Pose scratch(*model);
    Crossfade fade;
    for (int k = 0; k < 6; ++k) {
        fade.play(*model->clip(std::to_string(k)), 1.0f);
        fade.advance(0.1);
        double all = 0.0;
        double x = 0.0;
        for (const Playing& playing : fade.playing()) {
            all += playing.share;
            x += playing.share * std::pow(10.0, std::stod(std::string(playing.clip->name)));
        }
        EXPECT_NEAR(all, 1.0, 1e-6);
        ASSERT_TRUE(sample(pose, fade, scratch));
        EXPECT_NEAR(pose.local(0).translation.x, x, 1e-5 * x);
    }
    ASSERT_EQ(fade.playing().size(), Crossfade::kMost);
    EXPECT_EQ(fade.playing().front().clip->name, "2");
}

TEST(Crossfade, PosesOfOtherModelsAreRefused) {
    const Owned model(test::build_file(still_clips(1)));
    const Owned other(test::build_file(still_clips(1)));
    Pose pose(*model);
    Pose scratch(*other);
    Crossfade fade;
    fade.play(*model->clip("0"), 0.0f);
    EXPECT_FALSE(sample(pose, fade, scratch));
    EXPECT_EQ(pose.local(0).translation.x, 0.0f);
}

}  // namespace
}  // namespace bendy::crossfade_test
