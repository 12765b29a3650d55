#include <bendy/runtime/curve.h>

#include <bendy/runtime/model.h>
#include <bendy/runtime/sample.h>

#include "mutation/allocations.h"
#include "runtime/clip_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace bendy::curve_test {
namespace {

/// A curve with the memory of its keys.
struct Keys {
    Interpolation interpolation = Interpolation::linear;
    std::uint32_t components = 1;
    std::vector<float> times;
    std::vector<float> values;
    std::vector<std::uint16_t> packed = {};
    std::vector<float> box = {};

    [[nodiscard]] Curve curve() const {
        Curve view;
        view.components = components;
        view.interpolation = interpolation;
        view.keys = static_cast<std::uint32_t>(times.size());
        view.times = times;
        view.values = values;
        view.packed = packed;
        view.box = box;
        return view;
    }
    [[nodiscard]] std::vector<float> at(double seconds) const {
        std::vector<float> value(components, -77.0f);
        EXPECT_TRUE(sample_curve(curve(), seconds, value));
        return value;
    }
};

using Floats = std::vector<float>;

TEST(SampleCurve, StepHoldsTheKeyBefore) {
    const Keys keys{Interpolation::step, 2, {1, 2, 4}, {1, 10, 2, 20, 3, 30}};
    EXPECT_EQ(keys.at(0), (Floats{1, 10}));
    EXPECT_EQ(keys.at(1), (Floats{1, 10}));
    EXPECT_EQ(keys.at(std::nextafter(2.0, 0.0)), (Floats{1, 10}));
    EXPECT_EQ(keys.at(2), (Floats{2, 20}));
    EXPECT_EQ(keys.at(3.9), (Floats{2, 20}));
    EXPECT_EQ(keys.at(4), (Floats{3, 30}));
    EXPECT_EQ(keys.at(1e300), (Floats{3, 30}));
}

TEST(SampleCurve, LinearGoesStraightInEachComponent) {
    const Keys keys{Interpolation::linear, 4, {1, 3}, {0, 0, 0, 1, 1, -2, 4, 0}};
    EXPECT_EQ(keys.at(1.5), (Floats{0.25f, -0.5f, 1, 0.75f}));
    EXPECT_EQ(keys.at(-std::numeric_limits<double>::infinity()), (Floats{0, 0, 0, 1}));
    EXPECT_EQ(keys.at(std::numeric_limits<double>::infinity()), (Floats{1, -2, 4, 0}));
}

TEST(SampleCurve, NanSetsNothing) {
    const Keys keys{Interpolation::linear, 1, {0, 1}, {1, 2}};
    float value = 5.0f;
    EXPECT_EQ(sample_curve(keys.curve(), std::numeric_limits<double>::quiet_NaN(), {&value, 1}).error(),
              CallError::not_finite);
    EXPECT_EQ(sample_curve(keys.curve(), 0.5, {&value, 0}).error(), CallError::output_too_short);
    EXPECT_EQ(value, 5.0f);
}

TEST(SampleCurve, PackedValuesLieInTheirBox) {
    const Keys keys{Interpolation::linear, 2, {0, 1}, {}, {0, 65535, 65535, 0}, {-1, 10, 1, 20}};
    EXPECT_EQ(keys.at(0), (Floats{-1, 20}));
    EXPECT_EQ(keys.at(0.5), (Floats{0, 15}));
    EXPECT_EQ(keys.at(1), (Floats{1, 10}));
}

/// glTF 2.0, appendix C, in doubles and with a search from the front.
std::vector<double> defined(const Keys& keys, double seconds) {
    const std::size_t n = keys.components;
    const bool is_cubic = keys.interpolation == Interpolation::cubic;
    const auto number = [&](std::size_t key, std::size_t part, std::size_t c) {
        return double{keys.values[is_cubic ? (key * 3 + part) * n + c : key * n + c]};
    };
    std::vector<double> value;
    std::size_t key = 0;
    while (key + 1 < keys.times.size() && double{keys.times[key + 1]} <= seconds) ++key;
    const bool holds = seconds <= keys.times.front() || key + 1 == keys.times.size();
    for (std::size_t c = 0; c < n; ++c) {
        if (holds || keys.interpolation == Interpolation::step) {
            value.push_back(number(seconds <= keys.times.front() ? 0 : key, 1, c));
            continue;
        }
        const double length = double{keys.times[key + 1]} - keys.times[key];
        const double t = (seconds - keys.times[key]) / length;
        if (!is_cubic) {
            value.push_back((1.0 - t) * number(key, 1, c) + t * number(key + 1, 1, c));
            continue;
        }
        value.push_back((2 * t * t * t - 3 * t * t + 1) * number(key, 1, c) +
                        length * (t * t * t - 2 * t * t + t) * number(key, 2, c) +
                        (-2 * t * t * t + 3 * t * t) * number(key + 1, 1, c) +
                        length * (t * t * t - t * t) * number(key + 1, 0, c));
    }
    return value;
}

TEST(SampleCurve, IsWhatGltfDefinesForRandomCurves) {
    std::mt19937 random(20);
    std::uniform_real_distribution<float> numbers(-10.0f, 10.0f);
    std::uniform_real_distribution<float> steps(1e-3f, 0.5f);
    for (int round = 0; round < 300; ++round) {
        Keys keys;
        keys.interpolation = static_cast<Interpolation>(round % 3);
        keys.components = 1 + random() % 4;
        const std::size_t count = 1 + random() % 40;
        float time = numbers(random);
        for (std::size_t key = 0; key < count; ++key) keys.times.push_back(time += steps(random));
        keys.values.resize(count * keys.components * (round % 3 == 2 ? 3 : 1));
        std::generate(keys.values.begin(), keys.values.end(), [&] { return numbers(random); });
        for (int sample = 0; sample < 50; ++sample) {
            const double share = sample / 40.0 - 0.1;
            const double seconds = sample % 7 == 0
                                       ? double{keys.times[random() % count]}
                                       : keys.times.front() + share * (keys.times.back() - keys.times.front());
            const Floats value = keys.at(seconds);
            const std::vector<double> expected = defined(keys, seconds);
            for (std::size_t c = 0; c < keys.components; ++c)
                EXPECT_NEAR(value[c], expected[c], 1e-6 * (1.0 + std::abs(expected[c]))) << seconds;
        }
    }
}

TEST(SampleCurve, IsWhatTracksDo) {
    std::mt19937 random(21);
    std::uniform_real_distribution<float> numbers(-2.0f, 2.0f);
    for (const Interpolation interpolation : {Interpolation::step, Interpolation::linear, Interpolation::cubic}) {
        Keys keys{interpolation, 3, {0, 0.1f, 0.5f, 2}, {}};
        keys.values.resize(interpolation == Interpolation::cubic ? 36 : 12);
        std::generate(keys.values.begin(), keys.values.end(), [&] { return numbers(random); });
        const TrackView track{TrackPath::translation, interpolation, 0, 3, 4, keys.times, keys.values};
        for (float seconds = -0.5f; seconds < 2.5f; seconds += 0.01f) {
            Floats value(3);
            sample_track(track, {}, seconds, value);
            EXPECT_EQ(keys.at(seconds), value) << seconds;
        }
    }
}

/// A file whose key times were not checked may have any.
TEST(SampleCurve, TimesInAnyOrderAreReadInsideTheKeys) {
    std::mt19937 random(22);
    constexpr std::array kOdd{std::numeric_limits<float>::quiet_NaN(),
                              std::numeric_limits<float>::infinity(),
                              -std::numeric_limits<float>::infinity(),
                              0.0f,
                              1.0f,
                              2.0f,
                              -3.0f};
    for (int round = 0; round < 2'000; ++round) {
        Keys keys{static_cast<Interpolation>(round % 3), 1, {}, {}};
        const std::size_t count = 1 + random() % 6;
        for (std::size_t key = 0; key < count; ++key) keys.times.push_back(kOdd.at(random() % kOdd.size()));
        keys.values.resize(count * (round % 3 == 2 ? 3 : 1), 1.0f);
        for (const double seconds : {-4.0, 0.0, 0.5, 1.0, 3.0}) static_cast<void>(keys.at(seconds));
    }
}

TEST(SampleCurve, AllocatesNothing) {
    const Keys keys{Interpolation::cubic, 2, {0, 1}, Floats(12, 1.0f)};
    const Curve curve = keys.curve();
    std::array<float, 2> value{};
    const std::uint64_t before = test::allocations().count;
    for (int k = 0; k < 100; ++k) EXPECT_TRUE(sample_curve(curve, k * 0.01, value));
    EXPECT_EQ(test::allocations().count, before);
}

Curve named(std::string_view name, std::string_view path, CurveTarget kind = CurveTarget::nothing,
            std::uint32_t target = kNone) {
    Curve curve;
    curve.name = name;
    curve.path = path;
    curve.kind = kind;
    curve.target = target;
    return curve;
}

TEST(FindCurve, ByNameThenByPathOrByProperty) {
    Clip clip;
    clip.curves = {named("", "alphaCutoff", CurveTarget::material, 0),
                   named("", "alphaCutoff", CurveTarget::material, 1), named("alphaCutoff", "x"), named("Blink", "y")};
    EXPECT_EQ(find_curve(clip, "Blink"), &clip.curves[3]);
    EXPECT_EQ(find_curve(clip, "alphaCutoff"), &clip.curves[2]);
    EXPECT_EQ(find_curve(clip, "y"), &clip.curves[3]);
    EXPECT_EQ(find_curve(clip, "none"), nullptr);
    EXPECT_EQ(find_curve(clip, CurveTarget::material, 1, "alphaCutoff"), &clip.curves[1]);
    EXPECT_EQ(find_curve(clip, CurveTarget::joint, 1, "alphaCutoff"), nullptr);
}

TEST(FindCurve, OfAFile) {
    const std::array<float, 2> times{0.0f, 1.0f};
    const std::array<float, 2> values{3.0f, 5.0f};
    Curve curve = named("Glow", "/extras/glow");
    curve.keys = 2;
    curve.times = times;
    curve.values = values;
    test::Node clip = test::clip_node(
        {"clip", 0.0f, 1.0f, false, {{TrackPath::translation, 0, 3, {0.0f, 1.0f}, {0, 0, 0, 1, 0, 0}}}});
    clip.children.push_back(test::make_leaf(FourCC("CURV"), write_curve(curve)));
    test::ModelSpec spec;
    test::JointSpec joint;
    joint.rest = test::moved(0, 0, 0);
    spec.joints = {joint};
    spec.more = {clip};
    const test::Owned model(test::build_file(spec));
    const Curve* found = find_curve(model->clips()[0], "Glow");
    ASSERT_NE(found, nullptr);
    float value = 0.0f;
    EXPECT_TRUE(sample_curve(*found, 0.25, {&value, 1}));
    EXPECT_EQ(value, 3.5f);
}

}  // namespace
}  // namespace bendy::curve_test
