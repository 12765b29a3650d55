#include <bendy/runtime/root_motion.h>

#include <bendy/runtime/sample.h>

#include "runtime/clip_model.h"
#include "runtime/local_joints.h"
#include "runtime/packed_model.h"

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace bendy::root_motion_test {
namespace {

using test::Owned;

constexpr double kTurn = 2.0 * M_PI;

/// A turn about y.
glm::dmat4 yaw(double angle) {
    glm::dmat4 m(1.0);
    m[0] = {std::cos(angle), 0.0, -std::sin(angle), 0.0};
    m[2] = {std::sin(angle), 0.0, std::cos(angle), 0.0};
    return m;
}

glm::dmat4 shift(double x, double y, double z) {
    glm::dmat4 m(1.0);
    m[3] = {x, y, z, 1.0};
    return m;
}

void expect_near(const glm::dmat4& is, const glm::dmat4& expected, double tolerance) {
    for (int c = 0; c < 4; ++c) {
        for (int row = 0; row < 4; ++row) EXPECT_NEAR(is[c][row], expected[c][row], tolerance) << c << ' ' << row;
    }
}

void expect_near(const RootMotion& is, const glm::dmat4& expected, double tolerance) {
    expect_near(is.matrix(), expected, tolerance);
}

/// The root of a walk round a circle: keys of the position and yaw of hips at height 1, at rest at (0, 1, 0).
struct Walker {
    explicit Walker(double radius, double angle, int keys = 33, float start = 0.0f, float end = 2.0f) {
        test::ClipSpec clip;
        clip.name = "walk";
        clip.start = start;
        clip.end = end;
        clip.loop = true;
        test::TrackSpec place{TrackPath::translation, 0, 3, {}, {}};
        test::TrackSpec turn{TrackPath::rotation, 0, 4, {}, {}};
        for (int k = 0; k < keys; ++k) {
            const double share = k / (keys - 1.0);
            const double at = angle * share;
            const double seconds = start + (end - start) * share;
            place.times.push_back(static_cast<float>(seconds));
            turn.times.push_back(static_cast<float>(seconds));
            // Faces +z at first, the circle's middle at +x.
            for (const double c :
                 {radius - radius * std::cos(at), 1.0 + 0.1 * std::sin(7.0 * at), radius * std::sin(at)})
                place.values.push_back(static_cast<float>(c));
            for (const double c : {0.0, std::sin(0.5 * at), 0.0, std::cos(0.5 * at)})
                turn.values.push_back(static_cast<float>(c));
        }
        clip.tracks = {place, turn};
        spec.joints.resize(2);
        spec.joints[0] = {kNone, test::moved(0, 1, 0), {}, "hips"};
        spec.joints[1] = {0, test::moved(0, 0.5f, 0), {}, "spine"};
        spec.more.push_back(test::clip_node(clip));
    }

    test::ModelSpec spec;
};

TEST(RootMotion, StraightAheadIsWhatIsWalked) {
    test::ClipSpec clip;
    clip.name = "ahead";
    clip.start = 1.0f;
    clip.end = 3.0f;
    clip.tracks = {{TrackPath::translation, 0, 3, {1.0f, 3.0f}, {5, 1, 0, 5, 2, 4}}};
    test::ModelSpec spec;
    spec.joints.resize(1);
    spec.joints[0] = {kNone, test::moved(0, 1, 0), {}, "hips"};
    spec.more = {test::clip_node(clip)};
    const Owned model(test::build_file(spec));
    const Clip& walked = *model->clip("ahead");
    const RootPath path(*model, 0);
    expect_near(*path.between(walked, 1.5, 2.5), shift(0, 0, 2), 1e-6);
    expect_near(*path.between(walked, 2.5, 1.5), shift(0, 0, -2), 1e-6);
    Playback clock(1.0f, 3.0f, LoopMode::repeat);
    expect_near(*path.over(walked, clock.advance(11.0)), shift(0, 0, 22), 1e-5);  // 5 1/2 passes of 4
    clock.set_speed(-1.0);
    expect_near(*path.over(walked, clock.advance(3.0)), shift(0, 0, -6), 1e-5);
    Playback there_and_back(1.0f, 3.0f, LoopMode::ping_pong);
    expect_near(*path.over(walked, there_and_back.advance(9.0)), shift(0, 0, 2), 1e-5);
    Playback once(1.0f, 3.0f, LoopMode::once);
    expect_near(*path.over(walked, once.advance(1e9)), shift(0, 0, 4), 1e-5);

    RootAxes all;
    all.y = true;
    expect_near(*RootPath(*model, 0, all).between(walked, 1.0, 3.0), shift(0, 1, 4), 1e-6);
    RootAxes only_y{false, true, false, RootTurn::none};
    expect_near(*RootPath(*model, 0, only_y).between(walked, 1.0, 3.0), shift(0, 1, 0), 1e-6);
    expect_near(*RootPath(*model, kNone).between(walked, 1.0, 3.0), glm::dmat4(1.0), 0.0);
}

TEST(RootMotion, ACircleIsTheSameInAnyStepsAndOverLoops) {
    // A quarter turn in each clip of 2 seconds, on a circle of 3 metres.
    const Owned model(test::build_file(Walker(3.0, kTurn / 4.0).spec));
    const Clip& clip = *model->clip("walk");
    const RootPath path(*model, 0);
    const auto on_circle = [&](double angle) { return shift(3.0, 0, 0) * yaw(angle) * shift(-3.0, 0, 0); };
    expect_near(*path.between(clip, 0.0, 2.0), on_circle(kTurn / 4.0), 1e-6);
    // Keys are a 128th of a turn apart and the chords between them within 1.2 mm of the circle.
    expect_near(*path.between(clip, 0.0, 0.777), on_circle(kTurn / 8.0 * 0.777), 2e-3);
    Playback clock(clip);
    expect_near(*path.over(clip, clock.advance(2.0 * 7.0)), on_circle(kTurn * 7.0 / 4.0), 1e-5);

    // Whatever the steps, forth and back: the character is where one step would have taken it.
    std::mt19937 random(4);
    std::uniform_real_distribution<double> step(-3.0, 5.0);
    Playback small(clip);
    RootMotion character;
    double walked = 0.0;
    for (int k = 0; k < 3'000; ++k) {
        const double seconds = step(random);
        walked += seconds;
        character = compose(character, *path.over(clip, small.advance(seconds)));
    }
    Playback large(clip);
    expect_near(character, path.over(clip, large.advance(walked))->matrix(), 1e-3);
    EXPECT_GT(std::abs(small.passes()), 1'000);
}

TEST(RootMotion, WholeTurnsOverManyLoopsComeBack) {
    // Each clip is an eighth of a turn in place and a step of one metre ahead: after 8, where it began.
    test::ClipSpec spec_clip;
    spec_clip.name = "eighth";
    const double half = kTurn / 16.0;
    spec_clip.tracks = {{TrackPath::rotation,
                         0,
                         4,
                         {0.0f, 1.0f},
                         {0, 0, 0, 1, 0, static_cast<float>(std::sin(half)), 0, static_cast<float>(std::cos(half))}},
                        {TrackPath::translation, 0, 3, {0.0f, 1.0f}, {0, 0, 0, 0, 0, 1}}};
    test::ModelSpec spec;
    spec.joints.resize(1);
    spec.more = {test::clip_node(spec_clip)};
    const Owned model(test::build_file(spec));
    const Clip& clip = *model->clip("eighth");
    const RootPath path(*model, 0);
    const RootMotion one = *path.between(clip, 0.0, 1.0);
    expect_near(one, shift(0, 0, 1) * yaw(kTurn / 8.0), 1e-7);

    // The file's floats are not quite a unit quaternion of an eighth: how far its matrix turns is known in doubles.
    const double w = static_cast<float>(std::cos(half));
    const double y = static_cast<float>(std::sin(half));
    const double turned = std::atan2(2.0 * w * y, 1.0 - 2.0 * y * y);
    constexpr int kLoops = 80'000;
    // sum of yaw(k a) (0, 0, 1), k from 0: a geometric series of complex numbers z + i x.
    const auto closed_form = [&](int loops) {
        const double s = std::sin(0.5 * loops * turned) / std::sin(0.5 * turned);
        const double middle = 0.5 * (loops - 1) * turned;
        return shift(s * std::sin(middle), 0, s * std::cos(middle)) * yaw(loops * turned);
    };
    RootMotion step_by_step;
    Playback clock(0.0f, 1.0f, LoopMode::repeat);
    for (int k = 0; k < kLoops * 4; ++k) step_by_step = compose(step_by_step, *path.over(clip, clock.advance(0.25)));
    EXPECT_EQ(clock.passes(), kLoops);
    expect_near(step_by_step, closed_form(kLoops), 1e-9);
    Playback at_once(0.0f, 1.0f, LoopMode::repeat);
    expect_near(*path.over(clip, at_once.advance(kLoops)), closed_form(kLoops), 1e-9);
    at_once.seek(0.0);
    expect_near(*path.over(clip, at_once.advance(-kLoops)), glm::inverse(closed_form(kLoops)), 1e-9);
    // And it is where it began, but for what the floats lack, 80,000 times.
    EXPECT_LT(glm::length(step_by_step.translation), 80'000 * 1e-7);
}

/// Character times pose is the same with and without root motion, for the root and what hangs below it.
void expect_world_is_kept(const Model& model, const Clip& clip, std::uint32_t root, const RootAxes& axes,
                          double tolerance) {
    const RootPath path(model, root, axes);
    Pose pose(model);
    Pose authored(model);
    Playback clock(clip.start, clip.end, LoopMode::once);
    ASSERT_TRUE(sample(pose, &clip, clock.seconds()));
    RootMotion character = *path.extract(pose);
    for (int frame = 0; frame < 9; ++frame) {
        const PlayedInterval played = clock.advance(0.11 * (clip.end - clip.start));
        ASSERT_TRUE(sample(pose, &clip, clock.seconds()));
        ASSERT_TRUE(sample(authored, &clip, clock.seconds()));
        character = compose(character, *path.over(clip, played));
        const RootMotion taken = *path.extract(pose);
        expect_near(character, taken.matrix(), tolerance);
        for (std::size_t joint = root; joint < model.joints().size(); ++joint) {
            expect_near(character.matrix() * glm::dmat4(pose.model_space()[joint]),
                        glm::dmat4(authored.model_space()[joint]), tolerance);
        }
    }
}

TEST(RootMotion, WhatIsTakenOutOfThePoseIsInTheCharacter) {
    const Owned model(test::build_file(Walker(3.0, 2.0).spec));
    const Clip& clip = *model->clip("walk");
    const RootPath path(*model, 0);
    expect_world_is_kept(*model, clip, 0, {}, 2e-6);
    expect_world_is_kept(*model, clip, 0, {true, true, true, RootTurn::all}, 2e-6);
    expect_world_is_kept(*model, clip, 0, {false, false, true, RootTurn::none}, 2e-6);
    expect_world_is_kept(*model, clip, 0, {false, false, false, RootTurn::yaw}, 2e-6);
    expect_world_is_kept(*model, clip, 1, {}, 2e-6);

    Pose pose(*model);
    ASSERT_TRUE(sample(pose, &clip, 1.3f));
    const float height = pose.local(0).translation.y;
    EXPECT_TRUE(path.extract(pose));
    EXPECT_NEAR(pose.local(0).translation.x, 0.0, 1e-6);
    EXPECT_NEAR(pose.local(0).translation.y, height, 1e-6);  // bobbing stays
    EXPECT_NEAR(pose.local(0).translation.z, 0.0, 1e-6);
    EXPECT_NEAR(std::abs(pose.local(0).rotation.w), 1.0, 1e-6);
    expect_near(*path.extract(pose), glm::dmat4(1.0), 1e-6);
}

TEST(RootMotion, JointsAboveTheRootTurnAndScaleIt) {
    // As exporters do: centimetres and z up, under a joint that scales by 1/100 and turns by -90 degrees about x.
    Walker walker(300.0, 2.0);
    RestRecord above = test::turned(-90, 0);
    above.scale = {0.01f, 0.01f, 0.01f};
    above.translation = {0.5f, 0.0f, -0.25f};
    test::ModelSpec spec;
    spec.joints.resize(3);
    spec.joints[0] = {kNone, above, {}, "armature"};
    spec.joints[1] = {0, test::turned(90, 0), {}, "hips"};
    spec.joints[2] = {1, test::moved(0, 50, 0), {}, "spine"};
    test::ClipSpec clip;
    clip.name = "walk";
    const float r = std::sqrt(0.5f);
    clip.tracks = {{TrackPath::translation, 1, 3, {0.0f, 1.0f}, {0, 0, 100, 20, -300, 110}},
                   {TrackPath::rotation, 1, 4, {0.0f, 1.0f}, {r, 0, 0, r, 0.5f, 0.5f, 0.5f, 0.5f}}};
    spec.more = {test::clip_node(clip)};
    const Owned model(test::build_file(spec));
    const RootPath path(*model, 1);
    // In model space: 3 metres along +z and 0.2 along +x, from where x = 0.5 and z = -0.25; turned by a quarter about
    // y.
    expect_near(*path.at(*model->clip("walk"), 0.0), glm::dmat4(1.0), 1e-6);
    const glm::dmat4 expected = shift(0.7, 0, 2.75) * yaw(kTurn / 4.0) * shift(-0.5, 0, 0.25);
    expect_near(*path.at(*model->clip("walk"), 1.0), expected, 1e-5);
    expect_world_is_kept(*model, *model->clip("walk"), 1, {}, 1e-5);
}

TEST(RootMotion, PackedClipsMoveAsTheySample) {
    const Owned model(test::build_file(test::packed_spec(12, 50, 16)));
    const Clip& clip = *model->clip("packed");
    expect_world_is_kept(*model, clip, 0, {true, true, true, RootTurn::all}, 1e-4);  // a chain of metres, in floats
    // Further down, where uneven scales stand above, it is at least what the sampled pose has.
    for (const std::uint32_t joint : {3u, 7u}) {
        const RootPath path(*model, joint);
        Pose pose(*model);
        for (const float seconds : {0.5f, 0.93f, 1.77f, 2.5f}) {
            ASSERT_TRUE(sample(pose, &clip, seconds));
            expect_near(*path.at(clip, seconds), path.extract(pose)->matrix(), 1e-5);
        }
    }
}

TEST(RootMotion, LeaningIsNoTurn) {
    // Leaning about x and z, by any angle but a half turn, has no yaw; turned first, it keeps the turn's.
    test::ModelSpec spec;
    spec.joints.resize(1);
    const Owned model(test::build_file(spec));
    const RootPath path(*model, 0);
    std::mt19937 random(9);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    for (int k = 0; k < 100; ++k) {
        const double angle = 3.0 * number(random);
        const double lean = 1.5 * number(random);
        const double axis = 3.0 * number(random);
        const glm::dquat turned(std::cos(angle / 2), 0.0, std::sin(angle / 2), 0.0);
        const glm::dquat leaned(std::cos(lean / 2), std::sin(lean / 2) * std::cos(axis), 0.0,
                                std::sin(lean / 2) * std::sin(axis));
        Pose pose(*model);
        test::local_of(pose, 0)->rotation = glm::quat(turned * leaned);
        expect_near(*path.extract(pose), yaw(angle), 1e-6);
        const glm::dquat left(pose.local(0).rotation);
        EXPECT_NEAR(std::abs(glm::dot(left, leaned)), 1.0, 1e-6);
    }
    Pose pose(*model);
    test::local_of(pose, 0)->rotation = glm::quat(0.0f, 1.0f, 0.0f, 0.0f);  // upside down: no yaw
    expect_near(*path.extract(pose), glm::dmat4(1.0), 1e-6);
}

TEST(RootMotion, RepeatIsThenAgainAndAgain) {
    const RootMotion one{{0.3, -0.1, 1.2}, glm::normalize(glm::dquat(1.0, 0.1, 0.4, -0.2))};
    glm::dmat4 product(1.0);
    for (std::uint64_t times = 0; times < 70; ++times) {
        expect_near(repeat(one, times), product, 1e-12);
        product *= one.matrix();
    }
    expect_near(compose(one, inverse(one)), glm::dmat4(1.0), 1e-15);
    expect_near(blend(one, {}, 0.0), one.matrix(), 1e-12);
    expect_near(blend(one, {}, 1.0), glm::dmat4(1.0), 1e-12);
    const RootMotion half = blend({}, {{2, 0, 4}, {0.0, 0.0, 1.0, 0.0}}, 0.5);
    expect_near(half, shift(1, 0, 2) * yaw(kTurn / 4.0), 1e-12);
}

}  // namespace
}  // namespace bendy::root_motion_test
