#include <bendy/runtime/sample.h>

#include "pose/pose_state.h"
#include "runtime/build_model.h"
#include "runtime/clip_model.h"
#include "runtime/local_joints.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace bendy::sample_test {
namespace {

using test::Owned;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// A track with the memory of its keys.
struct Keys {
    TrackPath path;
    Interpolation interpolation;
    std::uint32_t components;
    std::vector<float> times;  ///< empty: fixed frames
    std::vector<float> values;
    std::uint32_t target = 0;

    [[nodiscard]] TrackView track() const {
        const std::size_t per_key = components * (interpolation == Interpolation::cubic ? std::size_t{3} : 1);
        return {path,  interpolation, target, components, static_cast<std::uint32_t>(values.size() / per_key),
                times, values};
    }
    [[nodiscard]] std::vector<float> at(float seconds, const Clip& clip = {}) const {
        std::vector<float> value(components, -77.0f);
        sample_track(track(), clip, seconds, value);
        return value;
    }
};

void expect_near(const std::vector<float>& value, const std::vector<double>& expected, double tolerance = 1e-6) {
    ASSERT_EQ(value.size(), expected.size());
    for (std::size_t c = 0; c < value.size(); ++c) EXPECT_NEAR(value[c], expected[c], tolerance) << "component " << c;
}

constexpr std::array kPaths{std::pair{TrackPath::translation, 3u}, std::pair{TrackPath::rotation, 4u},
                            std::pair{TrackPath::scale, 3u}, std::pair{TrackPath::weights, 5u}};

/// Unit vectors along x, y and z, w 0: as rotations, half turns round these axes.
std::vector<float> three_keys(std::uint32_t components) {
    std::vector<float> values(std::size_t{3} * components, 0.0f);
    for (std::size_t key = 0; key < 3; ++key) values[key * components + key] = 1.0f;
    return values;
}

std::vector<float> unit(std::uint32_t components, std::size_t axis) {
    std::vector<float> value(components, 0.0f);
    value[axis] = 1.0f;
    return value;
}

TEST(SampleTrack, StepHoldsTheKeyBeforeOnEveryPath) {
    for (const auto& [path, components] : kPaths) {
        const Keys keys{path, Interpolation::step, components, {1, 2, 4}, three_keys(components)};
        EXPECT_EQ(keys.at(1), unit(components, 0));
        EXPECT_EQ(keys.at(1.5f), unit(components, 0));
        EXPECT_EQ(keys.at(std::nextafter(2.0f, 0.0f)), unit(components, 0));
        EXPECT_EQ(keys.at(2), unit(components, 1));
        EXPECT_EQ(keys.at(std::nextafter(4.0f, 0.0f)), unit(components, 1));
        EXPECT_EQ(keys.at(4), unit(components, 2));
    }
}

TEST(SampleTrack, LinearGoesStraightExceptForRotations) {
    for (const auto& [path, components] : kPaths) {
        if (path == TrackPath::rotation) continue;
        const Keys keys{path, Interpolation::linear, components, {1, 2, 4}, three_keys(components)};
        std::vector<float> expected(components, 0.0f);
        expected[0] = 0.75f;
        expected[1] = 0.25f;
        EXPECT_EQ(keys.at(1.25f), expected);
        expected = std::vector<float>(components, 0.0f);
        expected[1] = 0.25f;
        expected[2] = 0.75f;
        EXPECT_EQ(keys.at(3.5f), expected);
    }
}

/// A cubic with leading coefficient a and its slope: Hermite interpolation gives it back whatever the keys' distance.
double curve(double a, double t) {
    return a * t * t * t - 2.0 * t * t + 3.0 * t - a;
}
double slope(double a, double t) {
    return 3.0 * a * t * t - 4.0 * t + 3.0;
}

TEST(SampleTrack, CubicFollowsTheCurveThatTheTangentsDescribe) {
    // Component c goes from 1 s to 3 s along the curve with a = c + 1 and on to 3.5 s along the one with a = -c - 2,
    // shifted to meet it.
    const std::vector<float> times{1.0f, 3.0f, 3.5f};
    for (const auto& [path, components] : kPaths) {
        const auto first = [](std::size_t c) { return static_cast<double>(c) + 1.0; };
        const auto second = [](std::size_t c) { return -static_cast<double>(c) - 2.0; };
        const auto value_at = [&](std::size_t c, double t) {
            return t <= 3.0 ? curve(first(c), t) : curve(second(c), t) - curve(second(c), 3.0) + curve(first(c), 3.0);
        };
        Keys keys{path, Interpolation::cubic, components, times, {}};
        for (const double t : {1.0, 3.0, 3.5}) {
            for (std::size_t c = 0; c < components; ++c)
                keys.values.push_back(t == 1.0 ? 123.0f
                                               : static_cast<float>(slope(t == 3.5 ? second(c) : first(c), t)));
            for (std::size_t c = 0; c < components; ++c) keys.values.push_back(static_cast<float>(value_at(c, t)));
            for (std::size_t c = 0; c < components; ++c)
                keys.values.push_back(t == 3.5 ? 321.0f
                                               : static_cast<float>(slope(t == 1.0 ? first(c) : second(c), t)));
        }
        for (const float seconds : {1.1f, 1.7f, 2.5f, 2.999f, 3.001f, 3.25f, 3.49f}) {
            std::vector<double> expected(components);
            for (std::size_t c = 0; c < components; ++c) expected[c] = value_at(c, double{seconds});
            double largest = 0.0;
            double square = 0.0;
            for (const double number : expected) {
                largest = std::max(largest, std::abs(number));
                square += number * number;
            }
            if (path == TrackPath::rotation) {
                for (double& number : expected) number /= std::sqrt(square);
                largest = 1.0;
            }
            expect_near(keys.at(seconds), expected, 1e-5 * largest);
        }
    }
}

TEST(SampleTrack, CubicTangentsCountPerSecond) {
    // From 0 to 0 over 4 s with slope 1 at the start and 0 at the end: t - t^2 / 2 + t^3 / 16.
    const Keys keys{TrackPath::weights, Interpolation::cubic, 1, {0, 4}, {9, 0, 1, 0, 0, 9}};
    EXPECT_FLOAT_EQ(keys.at(1)[0], 1.0f - 0.5f + 1.0f / 16.0f);
    EXPECT_FLOAT_EQ(keys.at(2)[0], 2.0f - 2.0f + 0.5f);
}

TEST(SampleTrack, CubicRotationsAreUnit) {
    const Keys keys{TrackPath::rotation, Interpolation::cubic, 4, {0, 1}, {0, 0, 0, 0, 0, 0, 0, 1, 3, 0, 0, 0,
                                                                           0, 3, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}};
    for (const float seconds : {0.1f, 0.3f, 0.5f, 0.9f}) {
        double square = 0.0;
        for (const float c : keys.at(seconds)) square += double{c} * c;
        EXPECT_NEAR(square, 1.0, 1e-6);
    }
}

TEST(SampleTrack, ACubicRotationThroughZeroIsNoNan) {
    // From q to -q with flat tangents: nothing is left half-way.
    const Keys keys{TrackPath::rotation, Interpolation::cubic, 4, {0, 1}, {0, 0, 0, 0, 0, 0, 0, 1,  0, 0, 0, 0,
                                                                           0, 0, 0, 0, 0, 0, 0, -1, 0, 0, 0, 0}};
    for (const float c : keys.at(0.5f)) EXPECT_TRUE(std::isfinite(c));
}

/// A turn round z by an angle in degrees, as a key.
std::vector<float> turn(double degrees, float sign = 1.0f) {
    const double half = degrees * M_PI / 360.0;
    return {0.0f, 0.0f, sign * static_cast<float>(std::sin(half)), sign * static_cast<float>(std::cos(half))};
}

Keys two_turns(const std::vector<float>& from, const std::vector<float>& to) {
    Keys keys{TrackPath::rotation, Interpolation::linear, 4, {0, 1}, from};
    keys.values.insert(keys.values.end(), to.begin(), to.end());
    return keys;
}

/// The angle in degrees round z, from -180 to 180, that a rotation turns by, whichever sign it has.
double angle_of(const std::vector<float>& q) {
    return std::remainder(2.0 * std::atan2(q[2], q[3]) * 180.0 / M_PI, 360.0);
}

TEST(SampleTrack, RotationsTurnEvenly) {
    const Keys keys = two_turns(turn(10), turn(130));
    for (const float u : {0.0f, 0.125f, 0.25f, 0.5f, 0.75f, 1.0f})
        EXPECT_NEAR(angle_of(keys.at(u)), 10.0 + 120.0 * u, 1e-4) << u;
}

TEST(SampleTrack, RotationsGoTheShortWay) {
    EXPECT_NEAR(std::abs(angle_of(two_turns(turn(170), turn(-170)).at(0.5f))), 180.0, 1e-4);
    EXPECT_NEAR(angle_of(two_turns(turn(0), turn(270)).at(0.5f)), -45.0, 1e-4);
    EXPECT_NEAR(angle_of(two_turns(turn(0), turn(179)).at(0.5f)), 89.5, 1e-4);
    EXPECT_NEAR(angle_of(two_turns(turn(0), turn(181)).at(0.5f)), -89.5, 1e-4);
}

TEST(SampleTrack, TheSignOfAKeyDoesNotMatter) {
    for (const float a : {1.0f, -1.0f}) {
        for (const float b : {1.0f, -1.0f}) {
            const Keys keys = two_turns(turn(20, a), turn(100, b));
            for (const float u : {0.25f, 0.5f, 0.9f}) {
                EXPECT_NEAR(angle_of(keys.at(u)), 20.0 + 80.0 * u, 1e-4);
                double square = 0.0;
                for (const float c : keys.at(u)) square += double{c} * c;
                EXPECT_NEAR(square, 1.0, 1e-6);
            }
        }
    }
    EXPECT_NEAR(angle_of(two_turns(turn(40), turn(40, -1.0f)).at(0.3f)), 40.0, 1e-4);
}

TEST(SampleTrack, NearlyEqualRotationsAreBlendedWithoutLoss) {
    for (const double apart : {0.0, 1e-5, 1e-3, 0.01, 0.1}) {
        const Keys keys = two_turns(turn(50), turn(50 + apart));
        for (const float u : {0.25f, 0.5f, 0.75f}) {
            const auto q = keys.at(u);
            EXPECT_NEAR(angle_of(q), 50.0 + apart * u, 1e-5) << apart;
            EXPECT_NEAR(std::hypot(q[2], q[3]), 1.0, 1e-6);
        }
    }
}

TEST(SampleTrack, AHalfTurnGoesOneWayOrTheOther) {
    for (const double degrees : {180.0, -180.0, 179.99999, 180.00001}) {
        const Keys keys = two_turns(turn(0), turn(degrees));
        EXPECT_NEAR(std::abs(angle_of(keys.at(0.5f))), 90.0, 1e-3);
        EXPECT_NEAR(std::abs(angle_of(keys.at(0.25f))), 45.0, 1e-3);
    }
    // Half turns round different axes: the way between is a turn round an axis between them.
    const Keys keys{TrackPath::rotation, Interpolation::linear, 4, {0, 1}, {1, 0, 0, 0, 0, 1, 0, 0}};
    expect_near(keys.at(0.5f), {std::sqrt(0.5), std::sqrt(0.5), 0, 0});
    expect_near(keys.at(1.0f / 3.0f), {std::sqrt(0.75), 0.5, 0, 0});
}

constexpr std::array kKinds{Interpolation::step, Interpolation::linear, Interpolation::cubic};

/// The keys of three_keys for any interpolation, with tangents that would show.
Keys keys_of(TrackPath path, std::uint32_t components, Interpolation interpolation, std::vector<float> times) {
    Keys keys{path, interpolation, components, std::move(times), {}};
    const std::vector<float> values = three_keys(components);
    const std::vector<float> tangent(components, 5.0f);
    for (std::size_t key = 0; key < 3; ++key) {
        const auto first = values.begin() + static_cast<std::ptrdiff_t>(key * components);
        if (interpolation == Interpolation::cubic)
            keys.values.insert(keys.values.end(), tangent.begin(), tangent.end());
        keys.values.insert(keys.values.end(), first, first + components);
        if (interpolation == Interpolation::cubic)
            keys.values.insert(keys.values.end(), tangent.begin(), tangent.end());
    }
    return keys;
}

TEST(SampleTrack, AtAKeyItsValueExactlyAndHeldOutsideTheKeys) {
    for (const auto& [path, components] : kPaths) {
        for (const Interpolation interpolation : kKinds) {
            const Keys keys = keys_of(path, components, interpolation, {-0.1f, 0.3f, 0.7f});
            EXPECT_EQ(keys.at(-0.1f), unit(components, 0));
            EXPECT_EQ(keys.at(0.3f), unit(components, 1));
            EXPECT_EQ(keys.at(0.7f), unit(components, 2));
            for (const float before : {std::nextafter(-0.1f, -1.0f), -5.0f, -3e38f, -kInfinity})
                EXPECT_EQ(keys.at(before), unit(components, 0));
            for (const float after : {std::nextafter(0.7f, 1.0f), 5.0f, 3e38f, kInfinity})
                EXPECT_EQ(keys.at(after), unit(components, 2));
        }
    }
}

TEST(SampleTrack, AtAKeyNotEvenTheSignOfZeroIsLost) {
    const Keys keys{TrackPath::weights, Interpolation::linear, 1, {0, 1, 2}, {5, -0.0f, 7}};
    EXPECT_TRUE(std::signbit(keys.at(1)[0]));
}

TEST(SampleTrack, ASingleKeyIsAlwaysMeant) {
    for (const auto& [path, components] : kPaths) {
        for (const Interpolation interpolation : kKinds) {
            Keys keys = keys_of(path, components, interpolation, {2});
            keys.values.resize(keys.values.size() / 3);
            Clip clip;
            clip.frame_rate = 30.0f;
            for (const bool fixed : {false, true}) {
                if (fixed) keys.times.clear();
                for (const float seconds : {-kInfinity, -1.0f, 0.0f, 2.0f, 3.0f, kInfinity, kNan}) {
                    EXPECT_EQ(keys.at(seconds, clip), unit(components, 0)) << seconds;
                }
            }
        }
    }
}

TEST(SampleTrack, FixedFramesStartAtTheClip) {
    Clip clip;
    clip.start = 0.5f;
    clip.end = 1.0f;
    clip.frame_rate = 4.0f;
    for (const auto& [path, components] : kPaths) {
        for (const Interpolation interpolation : kKinds) {
            const Keys keys = keys_of(path, components, interpolation, {});
            EXPECT_EQ(keys.at(0.5f, clip), unit(components, 0));
            EXPECT_EQ(keys.at(0.75f, clip), unit(components, 1));
            EXPECT_EQ(keys.at(1.0f, clip), unit(components, 2));
            for (const float before : {0.49f, -3e38f, -kInfinity})
                EXPECT_EQ(keys.at(before, clip), unit(components, 0));
            for (const float after : {1.01f, 3e38f, kInfinity}) EXPECT_EQ(keys.at(after, clip), unit(components, 2));
        }
        std::vector<float> between(components, 0.0f);
        if (path != TrackPath::rotation) {
            between[1] = 0.75f;
            between[2] = 0.25f;
        } else {
            between[1] = static_cast<float>(std::sin(M_PI * 3 / 8));
            between[2] = static_cast<float>(std::sin(M_PI / 8));
        }
        const auto value = keys_of(path, components, Interpolation::linear, {}).at(0.8125f, clip);
        for (std::size_t c = 0; c < components; ++c) EXPECT_FLOAT_EQ(value[c], between[c]);
        EXPECT_EQ(keys_of(path, components, Interpolation::step, {}).at(0.99f, clip), unit(components, 1));
    }
    // Tangents count per second: from 0 to 0 over 1/4 s with slope 1 at the start.
    const Keys cubic{TrackPath::weights, Interpolation::cubic, 1, {}, {9, 0, 1, 0, 0, 9}};
    EXPECT_FLOAT_EQ(cubic.at(0.625f, clip)[0], 0.25f * (0.5f - 2.0f * 0.25f + 0.125f));
}

TEST(SampleTrack, FixedFramesAreMetAtTheirTimes) {
    // The float nearest to k / 30 is not always past the frame; the value may not jump back by a frame because of that.
    Keys keys{TrackPath::weights, Interpolation::linear, 1, {}, {}};
    for (int frame = 0; frame < 300; ++frame) keys.values.push_back(static_cast<float>(frame));
    Clip clip;
    clip.start = 1.25f;
    clip.end = 1.25f + 299.0f / 30.0f;
    clip.frame_rate = 30.0f;
    for (int frame = 0; frame < 300; ++frame) {
        EXPECT_NEAR(keys.at(static_cast<float>(1.25 + frame / 30.0), clip)[0], frame, 3e-5) << frame;
    }
}

TEST(SampleTrack, NanSecondsGiveOneOfTheKeys) {
    for (const auto& [path, components] : kPaths) {
        for (const Interpolation interpolation : kKinds) {
            for (const bool fixed : {false, true}) {
                const Keys keys = keys_of(path, components, interpolation,
                                          fixed ? std::vector<float>() : std::vector<float>{0, 1, 2});
                Clip clip;
                clip.frame_rate = 10.0f;
                const auto value = keys.at(kNan, clip);
                EXPECT_TRUE(value == unit(components, 0) || value == unit(components, 2));
            }
        }
    }
}

// --- whole clips

void expect_rest(const Pose& pose, std::uint32_t joint) {
    const JointTransform& rest = pose.model().joints()[joint].rest;
    EXPECT_EQ(pose.local(joint).translation, rest.translation) << joint;
    EXPECT_EQ(pose.local(joint).scale, rest.scale) << joint;
    EXPECT_TRUE(pose.local(joint).rotation == rest.rotation) << joint;
}

void move_everything(Pose& pose) {
    test::change_locals(pose, [](JointTransform& local) { local = {glm::quat(0, 1, 0, 0), {7, 7, 7}, {5, 5, 5}}; });
    for (float& weight : pose.change_morph_weights()) weight = 9.0f;
}

TEST(Sample, SetsWhatItsTracksAnimate) {
    const Owned model(test::sample_file());
    Pose pose(*model);
    const Clip* run = model->clip("run");
    ASSERT_NE(run, nullptr);

    ASSERT_TRUE(
        sample(pose, run, 0.625f));  // half-way between the first two of three keys, a quarter of the way of two
    EXPECT_FALSE(PoseState::of(pose).stale.is_empty());
    EXPECT_EQ(pose.local(0).translation, glm::vec3(1.5f));
    EXPECT_EQ(pose.local(2).scale, glm::vec3(1.0f));    // step
    EXPECT_FLOAT_EQ(pose.morph_weights()[0], 0.25f);    // 0 to 1
    EXPECT_FLOAT_EQ(pose.morph_weights()[1], 0.4375f);  // 0.5 to 0.25
    const glm::quat frame = pose.local(2).rotation;     // from the identity to a half turn round y
    EXPECT_NEAR(frame.y, std::sqrt(0.5), 1e-6);
    EXPECT_NEAR(frame.w, std::sqrt(0.5), 1e-6);
    // Joint 1, cubic over 0.5 s: z rises as 3u^2 - 2u^3, w falls and has the tangents 6 and 7.
    const double u = 0.25;
    const double z = 3 * u * u - 2 * u * u * u;
    const double w = 1 - z + 0.5 * (u * u * u - 2 * u * u + u) * 6 + 0.5 * (u * u * u - u * u) * 7;
    EXPECT_NEAR(pose.local(1).rotation.z, z / std::hypot(z, w), 1e-6);
    EXPECT_NEAR(pose.local(1).rotation.w, w / std::hypot(z, w), 1e-6);

    ASSERT_TRUE(sample(pose, run, 0.75f));
    EXPECT_EQ(pose.local(0).translation, glm::vec3(2.0f));
    EXPECT_EQ(pose.local(2).scale, glm::vec3(2.0f));
    EXPECT_EQ(pose.local(2).rotation.y, 1.0f);
}

TEST(Sample, LeavesTheRestAtRest) {
    const Owned model(test::sample_file());
    Pose pose(*model);
    move_everything(pose);
    ASSERT_TRUE(sample(pose, model->clip("run"), 0.6f));
    expect_rest(pose, 3);
    EXPECT_EQ(pose.local(0).scale, glm::vec3(1.0f));
    EXPECT_EQ(pose.local(1).translation, model->joints()[1].rest.translation);
}

TEST(Sample, NoClipOrNoTimeIsTheRestPose) {
    const Owned model(test::sample_file());
    Pose pose(*model);
    for (const auto& [clip, seconds] :
         {std::pair{static_cast<const Clip*>(nullptr), 0.5f}, std::pair{model->clip("run"), kNan}}) {
        move_everything(pose);
        EXPECT_FALSE(sample(pose, clip, seconds));
        for (std::uint32_t joint = 0; joint < 4; ++joint) expect_rest(pose, joint);
        EXPECT_EQ(pose.morph_weights()[0], 0.125f);
        EXPECT_FALSE(PoseState::of(pose).stale.is_empty());
    }
}

TEST(Sample, InfiniteTimesAreHeldAtTheEnds) {
    const Owned model(test::sample_file());
    Pose pose(*model);
    ASSERT_TRUE(sample(pose, model->clip("run"), kInfinity));
    EXPECT_EQ(pose.local(0).translation, glm::vec3(3.0f));
    ASSERT_TRUE(sample(pose, model->clip("run"), -kInfinity));
    EXPECT_EQ(pose.local(0).translation, glm::vec3(1.0f));
}

/// Two meshes with one and two targets.
test::ModelSpec two_meshes() {
    test::ModelSpec spec;
    spec.joints.resize(2);
    spec.joints[1].parent = 0;
    spec.meshes.resize(2);
    for (std::size_t mesh = 0; mesh < 2; ++mesh) {
        spec.meshes[mesh].positions.resize(1);
        for (std::size_t target = 0; target <= mesh; ++target) {
            const MorphTargetRecord record{0.25f + static_cast<float>(target)};
            spec.meshes[mesh].more.push_back(
                test::make_container(FourCC("TARG"), {test::make_leaf(FourCC("TINF"), bytes_of(record))}));
        }
    }
    return spec;
}

std::vector<float> weights_of(const Pose& pose) {
    return {pose.morph_weights().begin(), pose.morph_weights().end()};
}

TEST(Sample, AnEmptyClipIsTheRestPose) {
    test::ModelSpec spec = two_meshes();
    spec.more = {test::clip_node({"empty"})};
    const Owned model(test::build_file(spec));
    Pose pose(*model);
    test::local_of(pose, 1)->translation.x = 7.0f;
    pose.change_morph_weights()[0] = 7.0f;
    ASSERT_TRUE(sample(pose, model->clip("empty"), 0.0f));
    expect_rest(pose, 1);
    EXPECT_EQ(weights_of(pose), (std::vector{0.25f, 0.25f, 1.25f}));
}

TEST(Sample, OneClipAfterAnotherKeepsNothingOfTheFirst) {
    test::ModelSpec spec = two_meshes();
    spec.more = {
        test::clip_node({"move",
                         0.0f,
                         1.0f,
                         false,
                         {{TrackPath::translation, 0, 3, {0}, {7, 7, 7}}, {TrackPath::weights, 0, 1, {0}, {7}}}}),
        test::clip_node({"grow", 0.0f, 1.0f, false, {{TrackPath::scale, 1, 3, {0}, {4, 4, 4}}}})};
    const Owned model(test::build_file(spec));
    Pose pose(*model);
    ASSERT_TRUE(sample(pose, model->clip("move"), 0.6f));
    EXPECT_EQ(pose.local(0).translation, glm::vec3(7.0f));
    ASSERT_TRUE(sample(pose, model->clip("grow"), 0.6f));
    expect_rest(pose, 0);
    EXPECT_EQ(pose.local(1).scale, glm::vec3(4.0f));
    EXPECT_EQ(pose.local(1).translation, model->joints()[1].rest.translation);
    EXPECT_EQ(weights_of(pose), (std::vector{0.25f, 0.25f, 1.25f}));
}

TEST(Sample, OfTwoKeysThatDifferByRoundingTheFirstHolds) {
    test::ModelSpec spec = two_meshes();
    constexpr float kRounded = 1.0f + 2.0f * std::numeric_limits<float>::epsilon();
    constexpr float kOther = 1.0f + 16.0f * std::numeric_limits<float>::epsilon();
    spec.more = {test::clip_node({"still",
                                  0.0f,
                                  1.0f,
                                  false,
                                  {{TrackPath::translation, 0, 3, {0, 1}, {1, 0, 0, kRounded, 0, 0}},
                                   {TrackPath::scale, 1, 3, {0, 1}, {1, 1, 1, kOther, 1, 1}}}})};
    const Owned model(test::build_file(spec));
    Pose pose(*model);
    ASSERT_TRUE(sample(pose, model->clip("still"), 1.0f));
    EXPECT_EQ(pose.local(0).translation, glm::vec3(1.0f, 0.0f, 0.0f));
    EXPECT_EQ(pose.local(1).scale, glm::vec3(kOther, 1.0f, 1.0f));
}

TEST(Sample, WeightsGoToTheMeshesOwnTargets) {
    test::ModelSpec spec = two_meshes();
    spec.more = {test::clip_node({"smile", 0.0f, 1.0f, false, {{TrackPath::weights, 1, 2, {0, 1}, {1, 2, 3, 6}}}})};
    const Owned model(test::build_file(spec));
    Pose pose(*model);
    EXPECT_EQ(weights_of(pose), (std::vector{0.25f, 0.25f, 1.25f}));
    ASSERT_TRUE(sample(pose, model->clip("smile"), 0.5f));
    EXPECT_EQ(weights_of(pose), (std::vector{0.25f, 2.0f, 4.0f}));
}

}  // namespace
}  // namespace bendy::sample_test
