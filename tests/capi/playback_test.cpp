// Clocks, markers, fades and crossfades through the C API, held against the C++ one; tracks and markers of clips.
#include "capi/open_handles.h"
#include "runtime/packed_model.h"

#include <bendy/runtime/pose.h>
#include <bendy/runtime/sample.h>

#include <glm/geometric.hpp>

#include <array>
#include <cmath>
#include <string>

namespace bendy::test::playback_test {
namespace {

class CPlayback : public testing::Test {
protected:
    std::string message(bendy_status status) {
        EXPECT_EQ(status, BENDY_BAD_ARGUMENT);
        return error_.message;
    }
    bendy_playback_info info(const PlaybackHandle& playback) {
        auto out = sized<bendy_playback_info>();
        EXPECT_EQ(bendy_get_playback(playback.get(), &out, &error_), BENDY_OK);
        return out;
    }

    const Owned expected_{walker_file()};
    const ModelHandle model_ = open_copy(walker_file());
    bendy_error error_ = BENDY_ERROR_INIT;
};

void expect_span(const bendy_time_span& span, const TimeSpan& expected) {
    EXPECT_EQ(span.from, expected.from);
    EXPECT_EQ(span.to, expected.to);
    EXPECT_EQ(span.has_end, expected.has_end ? 1u : 0u);
}

void expect_interval(const bendy_played& played, const PlayedInterval& expected) {
    expect_span(played.first, expected.first);
    expect_span(played.pass, expected.pass);
    expect_span(played.last, expected.last);
    EXPECT_EQ(played.passes, expected.passes);
    EXPECT_EQ(played.turns, expected.turns ? 1u : 0u);
}

TEST_F(CPlayback, RunsAsInCpp) {
    for (const std::uint32_t mode : {BENDY_LOOP_ONCE, BENDY_LOOP_REPEAT, BENDY_LOOP_PING_PONG}) {
        const PlaybackHandle playback(bendy_playback_new_range(0.5f, 2.0f, mode, &error_));
        ASSERT_NE(playback, nullptr) << error_.message;
        Playback cpp(0.5f, 2.0f, static_cast<LoopMode>(mode));
        ASSERT_EQ(bendy_playback_set_speed(playback.get(), 1.5, &error_), BENDY_OK);
        cpp.set_speed(1.5);
        for (const double step : {0.4, 1.0, 7.3, -0.9, -20.0}) {
            auto played = sized<bendy_played>();
            ASSERT_EQ(bendy_playback_advance(playback.get(), step, &played, &error_), BENDY_OK);
            expect_interval(played, cpp.advance(step));
            const bendy_playback_info now = info(playback);
            EXPECT_EQ(now.seconds, cpp.seconds());
            EXPECT_EQ(now.share, cpp.share());
            EXPECT_EQ(now.passes, cpp.passes());
            EXPECT_EQ(now.is_done, cpp.is_done() ? 1u : 0u);
            EXPECT_EQ(now.mode, mode);
            EXPECT_EQ(now.speed, 1.5);
        }
    }
}

TEST_F(CPlayback, OfAClipHasItsRangeAndSeeks) {
    const PlaybackHandle playback(bendy_playback_new(model_.get(), 0, &error_));
    EXPECT_EQ(info(playback).mode, static_cast<std::uint32_t>(BENDY_LOOP_REPEAT));
    EXPECT_EQ(info(playback).end, 1.0);
    const PlaybackHandle once(bendy_playback_new(model_.get(), 1, &error_));
    EXPECT_EQ(info(once).mode, static_cast<std::uint32_t>(BENDY_LOOP_ONCE));
    EXPECT_EQ(info(once).end, 2.0);
    ASSERT_EQ(bendy_playback_seek(once.get(), 0.5, &error_), BENDY_OK);
    EXPECT_EQ(info(once).seconds, 0.5f);
    ASSERT_EQ(bendy_playback_seek_share(once.get(), 0.75, &error_), BENDY_OK);
    EXPECT_EQ(info(once).seconds, 1.5f);
    ASSERT_EQ(bendy_playback_advance(once.get(), 9.0, nullptr, &error_), BENDY_OK);
    EXPECT_EQ(info(once).is_done, 1u);
    ASSERT_EQ(bendy_playback_set_mode(once.get(), BENDY_LOOP_REPEAT, &error_), BENDY_OK);
    EXPECT_EQ(info(once).is_done, 0u);
}

TEST_F(CPlayback, BadArgumentsAreErrorsAndChangeNothing) {
    EXPECT_EQ(bendy_playback_new(model_.get(), 2, &error_), nullptr);
    EXPECT_STREQ(error_.message, "clip 2 does not exist: the model has 2 clips");
    EXPECT_EQ(bendy_playback_new(nullptr, 0, &error_), nullptr);
    EXPECT_EQ(bendy_playback_new_range(0, INFINITY, 0, &error_), nullptr);
    EXPECT_EQ(bendy_playback_new_range(0, 1, 3, &error_), nullptr);
    EXPECT_STREQ(error_.message, "mode 3 is not a bendy_loop_mode");
    const PlaybackHandle playback(bendy_playback_new(model_.get(), 1, &error_));
    bendy_playback_seek(playback.get(), 0.5, nullptr);
    EXPECT_EQ(message(bendy_playback_advance(playback.get(), NAN, nullptr, &error_)),
              "seconds holds a number that is not finite");
    bendy_played unset{};
    message(bendy_playback_advance(playback.get(), 1.0, &unset, &error_));
    message(bendy_playback_advance(nullptr, 1.0, nullptr, &error_));
    message(bendy_playback_set_speed(playback.get(), INFINITY, &error_));
    message(bendy_playback_set_speed(nullptr, 1.0, &error_));
    message(bendy_playback_set_mode(playback.get(), 3, &error_));
    message(bendy_playback_seek(playback.get(), NAN, &error_));
    message(bendy_playback_seek_share(playback.get(), NAN, &error_));
    message(bendy_get_playback(playback.get(), nullptr, &error_));
    EXPECT_EQ(info(playback).seconds, 0.5f);
    EXPECT_EQ(info(playback).speed, 1.0);
    bendy_playback_free(nullptr);
}

TEST_F(CPlayback, MarkersOfAClipAreTheFiles) {
    EXPECT_EQ(bendy_marker_count(model_.get(), 0), 2u);
    EXPECT_EQ(bendy_marker_count(model_.get(), 1), 0u);
    EXPECT_EQ(bendy_marker_count(model_.get(), 2), 0u);
    EXPECT_EQ(bendy_marker_count(nullptr, 0), 0u);
    auto marker = sized<bendy_marker>();
    ASSERT_EQ(bendy_get_marker(model_.get(), 0, 1, &marker, &error_), BENDY_OK);
    EXPECT_STREQ(marker.name, "right");
    EXPECT_EQ(marker.seconds, 0.75f);
    EXPECT_EQ(message(bendy_get_marker(model_.get(), 0, 2, &marker, &error_)),
              "marker 2 does not exist: the clip has 2 markers");
}

TEST_F(CPlayback, MarkersPassedComeInPlaybackOrder) {
    const PlaybackHandle playback(bendy_playback_new(model_.get(), 0, &error_));
    auto played = sized<bendy_played>();
    ASSERT_EQ(bendy_playback_advance(playback.get(), 2.5, &played, &error_), BENDY_OK);
    std::uint64_t count = 0;
    ASSERT_EQ(bendy_count_markers(model_.get(), 0, &played, &count, &error_), BENDY_OK);
    EXPECT_EQ(count, 5u);
    std::array<std::uint32_t, 6> markers{9, 9, 9, 9, 9, 9};
    std::size_t written = 0;
    ASSERT_EQ(bendy_collect_markers(model_.get(), 0, &played, markers.data(), 6, &written, &error_), BENDY_OK);
    EXPECT_EQ(written, 5u);
    EXPECT_EQ(markers, (std::array<std::uint32_t, 6>{0, 1, 0, 1, 0, 9}));
    ASSERT_EQ(bendy_playback_advance(playback.get(), -0.5, &played, &error_), BENDY_OK);
    ASSERT_EQ(bendy_collect_markers(model_.get(), 0, &played, markers.data(), 6, &written, &error_), BENDY_OK);
    EXPECT_EQ(written, 1u);
    EXPECT_EQ(markers[0], 0u);
    ASSERT_EQ(bendy_playback_advance(playback.get(), 1e9, &played, &error_), BENDY_OK);
    ASSERT_EQ(bendy_count_markers(model_.get(), 0, &played, &count, &error_), BENDY_OK);
    EXPECT_EQ(count, 2000000000u);
    ASSERT_EQ(bendy_collect_markers(model_.get(), 0, &played, markers.data(), 2, &written, &error_), BENDY_OK);
    EXPECT_EQ(written, 2u) << "as many as there is room for";
    ASSERT_EQ(bendy_collect_markers(model_.get(), 0, &played, nullptr, 0, &written, &error_), BENDY_OK);
    EXPECT_EQ(written, 0u);
    played.first.to = NAN;
    EXPECT_EQ(message(bendy_count_markers(model_.get(), 0, &played, &count, &error_)),
              "to holds a number that is not finite");
    message(bendy_collect_markers(model_.get(), 0, nullptr, markers.data(), 2, &written, &error_));
    played.first.to = 0.0;
    message(bendy_collect_markers(model_.get(), 0, &played, nullptr, 2, &written, &error_));
    message(bendy_collect_markers(model_.get(), 0, &played, markers.data(), 2, nullptr, &error_));
    message(bendy_count_markers(model_.get(), 2, &played, &count, &error_));
}

TEST_F(CPlayback, TracksAreTheClipsAndAreSampledAsInCpp) {
    EXPECT_EQ(bendy_track_count(model_.get(), 0), 2u);
    EXPECT_EQ(bendy_track_count(model_.get(), 2), 0u);
    auto track = sized<bendy_track>();
    ASSERT_EQ(bendy_get_track(model_.get(), 0, 0, &track, &error_), BENDY_OK);
    EXPECT_EQ(track.path, static_cast<std::uint32_t>(BENDY_PATH_TRANSLATION));
    EXPECT_EQ(track.interpolation, static_cast<std::uint32_t>(BENDY_LINEAR));
    EXPECT_EQ(track.target, 0u);
    EXPECT_EQ(track.components, 3u);
    ASSERT_EQ(track.keys, 2u);
    EXPECT_EQ(track.times[1], 1.0f);
    EXPECT_EQ(track.values[3], 3.0f);
    std::array<float, 4> values{}, wanted{};
    ASSERT_EQ(bendy_sample_track(model_.get(), 0, 1, 0.3f, values.data(), 4, &error_), BENDY_OK);
    sample_track(expected_->clips()[0].tracks[1], expected_->clips()[0], 0.3f, wanted);
    EXPECT_EQ(values, wanted);
    EXPECT_GT(values[1], 0.1f);
    EXPECT_EQ(message(bendy_sample_track(model_.get(), 0, 1, 0.3f, values.data(), 3, &error_)),
              "values has room for 3, 4 are needed");
    EXPECT_EQ(message(bendy_sample_track(model_.get(), 0, 1, NAN, values.data(), 4, &error_)),
              "seconds is not a number");
    message(bendy_get_track(model_.get(), 0, 2, &track, &error_));
    const ModelHandle fixed = open_copy(sample_file());
    ASSERT_EQ(bendy_get_track(fixed.get(), 0, 4, &track, &error_), BENDY_OK);
    EXPECT_EQ(track.times, nullptr) << "fixed frames";
}

TEST_F(CPlayback, PackedFramesAreWhereTracksBend) {
    const Buffer file = build_file(packed_spec(30, 50, 16));
    const ModelHandle packed = open_copy(file);
    ASSERT_EQ(bendy_packed_frame_count(packed.get(), 0), 50u);
    std::array<float, 50> times{};
    ASSERT_EQ(bendy_packed_frame_times(packed.get(), 0, times.data(), 50, &error_), BENDY_OK);
    EXPECT_EQ(times.front(), 0.5f);
    EXPECT_EQ(times.back(), static_cast<float>(0.5 + 49.0 / 24.0));
    const Owned model(file);
    Pose pose(*model);
    const auto translation = [&](float seconds) {
        EXPECT_TRUE(sample(pose, &model->clips()[0], seconds));
        return pose.local(1).translation;
    };
    const glm::vec3 left = translation(times[20]), right = translation(times[21]);
    EXPECT_GT(glm::distance(left, right), 1e-4f);
    EXPECT_LT(glm::distance(translation(0.5f * (times[20] + times[21])), 0.5f * (left + right)), 1e-6f);
    EXPECT_EQ(message(bendy_packed_frame_times(packed.get(), 0, times.data(), 49, &error_)),
              "times has room for 49, 50 are needed");
    message(bendy_packed_frame_times(packed.get(), 0, nullptr, 50, &error_));
    message(bendy_packed_frame_times(packed.get(), 1, times.data(), 50, &error_));
    EXPECT_EQ(bendy_packed_frame_count(packed.get(), 1), 0u);
    EXPECT_EQ(bendy_packed_frame_count(nullptr, 0), 0u);
    EXPECT_EQ(bendy_packed_frame_count(model_.get(), 0), 0u) << "not packed";
    EXPECT_EQ(bendy_packed_frame_times(model_.get(), 0, nullptr, 0, &error_), BENDY_OK);
}

TEST_F(CPlayback, FadesRunAsInCpp) {
    const FadeHandle fade(bendy_fade_new(0.25f, &error_));
    Fade cpp(0.25f);
    EXPECT_EQ(bendy_fade_weight(fade.get()), 0.25f);
    ASSERT_EQ(bendy_fade_to(fade.get(), 1.0f, 2.0f, BENDY_EASING_SMOOTH, &error_), BENDY_OK);
    cpp.to(1.0f, 2.0f);
    for (const double step : {0.5, 1.0, 1.0}) {
        ASSERT_EQ(bendy_fade_advance(fade.get(), step, &error_), BENDY_OK);
        cpp.advance(step);
        EXPECT_EQ(bendy_fade_weight(fade.get()), cpp.weight());
        EXPECT_EQ(bendy_fade_is_done(fade.get()), cpp.is_done() ? 1u : 0u);
    }
    EXPECT_EQ(bendy_fade_weight(fade.get()), 1.0f);
    EXPECT_EQ(bendy_ease(BENDY_EASING_SMOOTH, 0.25f), 0.15625f);
    EXPECT_EQ(bendy_ease(BENDY_EASING_LINEAR, 0.25f), 0.25f);
    EXPECT_EQ(bendy_fade_new(NAN, &error_), nullptr);
    EXPECT_EQ(message(bendy_fade_to(fade.get(), 0.0f, 1.0f, 2, &error_)), "easing 2 is not a bendy_easing");
    message(bendy_fade_to(fade.get(), NAN, 1.0f, 0, &error_));
    message(bendy_fade_advance(fade.get(), NAN, &error_));
    message(bendy_fade_advance(nullptr, 1.0, &error_));
    EXPECT_EQ(bendy_fade_weight(nullptr), 0.0f);
    EXPECT_EQ(bendy_fade_weight(fade.get()), 1.0f);
    bendy_fade_free(nullptr);
}

TEST_F(CPlayback, CrossfadesMixAsInCpp) {
    const CrossfadeHandle fade(bendy_crossfade_new(model_.get(), &error_));
    Crossfade cpp;
    EXPECT_EQ(bendy_crossfade_count(fade.get()), 0u);
    ASSERT_EQ(bendy_crossfade_play(fade.get(), 0, nullptr, 0.0f, BENDY_EASING_SMOOTH, &error_), BENDY_OK);
    cpp.play(expected_->clips()[0], 0.0f);
    ASSERT_EQ(bendy_crossfade_advance(fade.get(), 0.7, &error_), BENDY_OK);
    cpp.advance(0.7);
    const PlaybackHandle fast(bendy_playback_new_range(0.0f, 2.0f, BENDY_LOOP_PING_PONG, &error_));
    bendy_playback_set_speed(fast.get(), 3.0, nullptr);
    Playback cpp_fast(0.0f, 2.0f, LoopMode::ping_pong);
    cpp_fast.set_speed(3.0);
    ASSERT_EQ(bendy_crossfade_play(fade.get(), 1, fast.get(), 0.5f, BENDY_EASING_LINEAR, &error_), BENDY_OK);
    cpp.play(expected_->clips()[1], cpp_fast, 0.5f, Easing::linear);
    const PoseHandle pose = new_pose(model_);
    const PoseHandle scratch = new_pose(model_);
    Pose cpp_pose(*expected_);
    Pose cpp_scratch(*expected_);
    for (int step = 0; step < 3; ++step) {
        ASSERT_EQ(bendy_crossfade_advance(fade.get(), 0.2, &error_), BENDY_OK);
        cpp.advance(0.2);
        ASSERT_EQ(bendy_crossfade_count(fade.get()), cpp.playing().size());
        for (std::uint32_t number = 0; number < cpp.playing().size(); ++number) {
            const Playing& wanted = cpp.playing()[number];
            auto playing = sized<bendy_playing>();
            ASSERT_EQ(bendy_get_playing(fade.get(), number, &playing, &error_), BENDY_OK);
            EXPECT_EQ(playing.clip, wanted.clip - expected_->clips().data());
            EXPECT_EQ(playing.share, wanted.share);
            EXPECT_EQ(playing.weight, wanted.fade.weight());
            EXPECT_EQ(playing.seconds, wanted.playback.seconds());
            auto played = sized<bendy_played>();
            ASSERT_EQ(bendy_get_played(fade.get(), number, &played, &error_), BENDY_OK);
            expect_interval(played, wanted.played);
        }
        ASSERT_EQ(bendy_sample_crossfade(pose.get(), fade.get(), scratch.get(), &error_), BENDY_OK) << error_.message;
        ASSERT_TRUE(sample(cpp_pose, cpp, cpp_scratch));
        std::array<bendy_transform, 2> local{};
        ASSERT_EQ(bendy_get_local(pose.get(), 0, 2, local.data(), &error_), BENDY_OK);
        for (std::uint32_t joint = 0; joint < 2; ++joint) {
            EXPECT_EQ(local[joint].translation[0], cpp_pose.local(joint).translation.x);
            EXPECT_EQ(local[joint].translation[2], cpp_pose.local(joint).translation.z);
            EXPECT_EQ(local[joint].rotation[1], cpp_pose.local(joint).rotation.y);
        }
    }
    EXPECT_EQ(bendy_crossfade_count(fade.get()), 1u) << "the first clip is covered";
}

TEST_F(CPlayback, NewestClockOfACrossfadeCanBeChanged) {
    const CrossfadeHandle fade(bendy_crossfade_new(model_.get(), &error_));
    const PlaybackHandle clock(bendy_playback_new(model_.get(), 1, &error_));
    EXPECT_EQ(message(bendy_crossfade_set_playback(fade.get(), clock.get(), &error_)), "the crossfade plays no clip");
    bendy_crossfade_play(fade.get(), 0, nullptr, 0.0f, 0, nullptr);
    bendy_crossfade_play(fade.get(), 1, nullptr, 1.0f, 0, nullptr);
    ASSERT_EQ(bendy_crossfade_get_playback(fade.get(), 1, clock.get(), &error_), BENDY_OK);
    ASSERT_EQ(bendy_playback_seek(clock.get(), 1.5, &error_), BENDY_OK);
    ASSERT_EQ(bendy_crossfade_set_playback(fade.get(), clock.get(), &error_), BENDY_OK);
    auto playing = sized<bendy_playing>();
    ASSERT_EQ(bendy_get_playing(fade.get(), 1, &playing, &error_), BENDY_OK);
    EXPECT_EQ(playing.seconds, 1.5f);
    ASSERT_EQ(bendy_get_playing(fade.get(), 0, &playing, &error_), BENDY_OK);
    EXPECT_EQ(playing.seconds, 0.0f);
}

TEST_F(CPlayback, CrossfadesRefuseBadArguments) {
    const CrossfadeHandle fade(bendy_crossfade_new(model_.get(), &error_));
    const PoseHandle pose = new_pose(model_);
    const PoseHandle scratch = new_pose(model_);
    const ModelHandle other = open_copy(walker_file());
    const PoseHandle other_pose = new_pose(other);
    EXPECT_EQ(message(bendy_sample_crossfade(pose.get(), fade.get(), scratch.get(), &error_)),
              "the crossfade plays no clip");
    EXPECT_EQ(message(bendy_crossfade_play(fade.get(), 2, nullptr, 0, 0, &error_)),
              "clip 2 does not exist: the model has 2 clips");
    message(bendy_crossfade_play(fade.get(), 0, nullptr, NAN, 0, &error_));
    message(bendy_crossfade_play(fade.get(), 0, nullptr, 0, 2, &error_));
    EXPECT_EQ(bendy_crossfade_count(fade.get()), 0u);
    ASSERT_EQ(bendy_crossfade_play(fade.get(), 0, nullptr, 0, 0, &error_), BENDY_OK);
    EXPECT_EQ(message(bendy_sample_crossfade(other_pose.get(), fade.get(), scratch.get(), &error_)),
              "crossfade is of another model than pose");
    EXPECT_EQ(message(bendy_sample_crossfade(pose.get(), fade.get(), pose.get(), &error_)),
              "scratch is the pose itself");
    message(bendy_sample_crossfade(pose.get(), fade.get(), nullptr, &error_));
    message(bendy_sample_crossfade(pose.get(), nullptr, scratch.get(), &error_));
    message(bendy_crossfade_advance(fade.get(), NAN, &error_));
    auto playing = sized<bendy_playing>();
    EXPECT_EQ(message(bendy_get_playing(fade.get(), 1, &playing, &error_)),
              "playing clip 1 does not exist: the crossfade has 1 playing clip");
    auto played = sized<bendy_played>();
    message(bendy_get_played(fade.get(), 1, &played, &error_));
    message(bendy_crossfade_get_playback(fade.get(), 0, nullptr, &error_));
    EXPECT_EQ(bendy_crossfade_new(nullptr, &error_), nullptr);
    EXPECT_EQ(bendy_crossfade_count(nullptr), 0u);
    bendy_crossfade_free(nullptr);
}

}  // namespace
}  // namespace bendy::test::playback_test
