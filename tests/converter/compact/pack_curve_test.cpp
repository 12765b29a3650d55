#include "optimise/compact/pack_curve.h"

#include "convert/build_compact.h"
#include "optimise/compare/compare_curves.h"
#include "optimise/passes/merge_clips.h"

#include <bendy/converter/build_chunks.h>
#include <bendy/converter/compare_characters.h>
#include <bendy/converter/import.h>
#include <bendy/format/document.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

namespace bendy::converter::pack_curve_test {
namespace {

Curve curve_of(const std::string& path, std::vector<float> times, std::vector<float> values,
               Interpolation interpolation = Interpolation::linear) {
    Curve curve;
    curve.path = path;
    curve.interpolation = interpolation;
    curve.components =
        static_cast<std::uint32_t>(values.size() / times.size() / (interpolation == Interpolation::cubic ? 3 : 1));
    curve.times = std::move(times);
    curve.values = std::move(values);
    return curve;
}

/// Keys 1/30 s apart with random values.
Curve random_curve(std::size_t keys, std::uint32_t components, float low, float high, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<float> times;
    std::vector<float> values;
    for (std::size_t key = 0; key < keys; ++key) {
        times.push_back(static_cast<float>(key) / 30.0f);
        for (std::uint32_t c = 0; c < components; ++c) {
            const float share = static_cast<float>(random() % 10'000) / 10'000.0f;
            values.push_back(low + share * (high - low) * static_cast<float>(c + 1));
        }
    }
    return curve_of("/extras/random", std::move(times), std::move(values));
}

TEST(PackCurve, ValuesComeBackWithinHalfAStep) {
    for (std::uint32_t components = 1; components <= 4; ++components) {
        const Curve curve = random_curve(100, components, -3.0f, 5.0f, components);
        const auto packed = pack_curve(curve);
        ASSERT_TRUE(packed);
        const CurveView view = packed->view(curve);
        double largest = 0.0;
        for (std::size_t i = 0; i < curve.values.size(); ++i) {
            const double error = std::abs(double{view.value(i)} - curve.values[i]);
            const std::size_t c = i % components;
            EXPECT_LE(error, 0.51 * (double{packed->box[components + c]} - packed->box[c]) / 65535.0);
            largest = std::max(largest, error);
        }
        EXPECT_GT(largest, 0.0);
        EXPECT_GE(double{packed->max_error}, largest);
        EXPECT_LE(double{packed->max_error}, largest * 1.000001);
        EXPECT_GT(packed->share, 0.0);
        EXPECT_LE(packed->share, 0.51 / 65535.0);
    }
}

TEST(PackCurve, WholeNumbersArePackedOnlyWhereTheyComeBack) {
    std::vector<float> times;
    std::vector<float> flags;
    std::vector<float> counts;
    for (int key = 0; key < 64; ++key) {
        times.push_back(static_cast<float>(key));
        flags.push_back(static_cast<float>(key * 7 % 3 == 0));
        counts.push_back(static_cast<float>(key * 7 % 65));
    }
    const auto packed = pack_curve(curve_of("/extras/flag", times, flags, Interpolation::step));
    if (packed) {
        EXPECT_EQ(packed->max_error, 0.0f);
    }
    EXPECT_FALSE(pack_curve(curve_of("/extras/count", times, counts, Interpolation::step)));
}

TEST(PackCurve, SmallAndCubicCurvesStayExact) {
    EXPECT_FALSE(pack_curve(curve_of("/extras/x", {0, 1}, {0.1f, 0.7f})));
    EXPECT_FALSE(pack_curve(curve_of("/extras/x", {0}, {0.1f})));
    Curve cubic = random_curve(300, 1, 0, 1, 3);
    cubic.interpolation = Interpolation::cubic;
    cubic.times.resize(100);
    EXPECT_FALSE(pack_curve(cubic));
}

TEST(PackCurve, ExtremesDoNoHarm) {
    Curve curve = random_curve(64, 1, 0, 1, 4);
    curve.values[0] = -3.4e38f;
    curve.values[1] = 3.4e38f;
    const auto packed = pack_curve(curve);
    if (packed) {
        EXPECT_TRUE(std::isfinite(packed->max_error));
        EXPECT_TRUE(std::isfinite(packed->view(curve).value(0)));
    }
    std::fill(curve.values.begin(), curve.values.end(), 1.5f);
    if (const auto still = pack_curve(curve)) {
        EXPECT_EQ(still->max_error, 0.0f);
        EXPECT_EQ(still->view(curve).value(5), 1.5f);
    }
    for (std::size_t i = 0; i < curve.values.size(); ++i)  // steps finer than floats
        curve.values[i] = std::nextafter(16'777'216.0f, i % 3 == 0 ? 0.0f : 1e30f) + static_cast<float>(i);
    if (const auto fine = pack_curve(curve)) {
        EXPECT_EQ(fine->max_error, 0.0f);
    }
}

Scene lone_joint(std::vector<Curve> curves) {
    Scene scene;
    scene.joints.resize(1);
    scene.materials.resize(2);
    scene.materials[0].name = "a";
    scene.materials[1].name = "b";
    Clip clip;
    clip.name = "clip";
    clip.curves = std::move(curves);
    scene.clips = {clip};
    return scene;
}

TEST(PackCurve, CompactFilesPackAndSayTheError) {
    const Scene scene = lone_joint({random_curve(200, 3, 0, 1, 5), curve_of("/extras/x", {0, 1}, {0.1f, 0.7f})});
    Report report;
    const std::vector<std::byte> bytes = build_compact(scene, {.bound = {0.001, false}}, "test", report);
    ASSERT_TRUE(validate(bytes).empty());
    ASSERT_TRUE(report.compact);
    EXPECT_EQ(report.compact->curves, 2u);
    EXPECT_EQ(report.compact->packed_curves, 1u);
    EXPECT_GT(report.compact->curve_error, 0.0);
    EXPECT_LE(report.compact->curve_error, 0.51 / 65535.0);
    const auto again = import_bendy(bytes, report);
    ASSERT_TRUE(again);
    ASSERT_EQ(again->clips.at(0).curves.size(), 2u);
    EXPECT_EQ(again->clips[0].curves[1].values, scene.clips[0].curves[1].values);
    EXPECT_NE(again->clips[0].curves[0].values, scene.clips[0].curves[0].values);
    const auto compared = compare_characters(scene, *again, {0.001, false}, {});
    EXPECT_TRUE(compared.differences.empty()) << compared.differences.front().place;
}

// --- curves of two characters

std::vector<std::string> differences(const Scene& a, const Scene& b) {
    std::vector<std::string> lines;
    for (const CharacterDifference& difference : compare_characters(a, b, {0.001, false}, {}).differences)
        lines.push_back(difference.place + ": " + difference.what);
    return lines;
}

TEST(CompareCurves, AChangeIsADifference) {
    Curve paint = curve_of("alphaCutoff", {0, 1, 2}, {0, 1, 0});
    paint.kind = CurveTarget::material;
    paint.target = 0;
    const Curve wind = curve_of("/extras/wind", {0, 1}, {0, 0, 1, 1});
    const Scene scene = lone_joint({paint, wind});
    EXPECT_TRUE(differences(scene, scene).empty());

    Scene other = scene;
    std::swap(other.materials[0], other.materials[1]);
    other.clips[0].curves[0].target = 1;  // the same material by name
    std::swap(other.clips[0].curves[0], other.clips[0].curves[1]);
    EXPECT_TRUE(differences(scene, other).empty());

    other = scene;  // the same line by one key more
    other.clips[0].curves[1] = curve_of("/extras/wind", {0, 0.5f, 1}, {0, 0, 0.5f, 0.5f, 1, 1});
    EXPECT_TRUE(differences(scene, other).empty());

    other.clips[0].curves[1].values[2] = 0.75f;
    EXPECT_EQ(differences(scene, other),
              std::vector<std::string>{"clip \"clip\", curve \"/extras/wind\": up to 0.25 apart, at 0.5 s"});
    other = scene;
    other.clips[0].curves[0].interpolation = Interpolation::step;
    EXPECT_EQ(differences(scene, other),
              std::vector<std::string>{"clip \"clip\", curve \"alphaCutoff\": up to 0.5 apart, at 0.5 s"});
    other = scene;
    other.clips[0].curves[0].target = 1;
    EXPECT_EQ(differences(scene, other), (std::vector<std::string>{"clip \"clip\", curve \"alphaCutoff\": ",
                                                                   "clip \"clip\", curve \"alphaCutoff\": "}));
    other = scene;
    other.clips[0].curves[1].name = "gust";
    EXPECT_EQ(differences(scene, other),
              std::vector<std::string>{"clip \"clip\", curve \"/extras/wind\": name: \"\" -> \"gust\""});
    other = scene;
    other.clips[0].curves[1] = curve_of("/extras/wind", {0, 1}, {0, 1});
    EXPECT_EQ(differences(scene, other),
              std::vector<std::string>{"clip \"clip\", curve \"/extras/wind\": components: 2 -> 1"});
}

TEST(MergeClipsWithCurves, CurvesOfOnePropertyStayApart) {
    Scene scene = lone_joint({curve_of("/extras/a", {0}, {1})});
    scene.clips.push_back(scene.clips[0]);
    scene.clips.push_back(scene.clips[0]);
    scene.clips[1].curves[0].path = "/extras/b";
    Report report;
    EXPECT_EQ(merge_clips(scene, report), 2u);
    ASSERT_EQ(scene.clips[0].curves.size(), 2u);
    EXPECT_EQ(scene.clips[0].curves[1].path, "/extras/b");
    EXPECT_EQ(scene.clips[1].curves.size(), 1u);
}

}  // namespace
}  // namespace bendy::converter::pack_curve_test
