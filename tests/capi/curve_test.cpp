// Named curves through the C API.
#include "capi/open_handles.h"

#include "runtime/clip_model.h"

#include <bendy/format/curve.h>

#include <array>
#include <cmath>
#include <string>

namespace bendy::test::curve_test {
namespace {

/// One joint and a clip with two curves: Glow from 3 to 5, and a material's colour.
Buffer file_with_curves() {
    const std::array<float, 2> times{0.0f, 1.0f};
    const std::array<float, 2> glows{3.0f, 5.0f};
    const std::array<float, 6> colours{0, 0, 0, 1, 2, 4};
    Curve glow;
    glow.name = "Glow";
    glow.path = "/extras/glow";
    glow.keys = 2;
    glow.times = times;
    glow.values = glows;
    Curve colour = glow;
    colour.name = "";
    colour.path = "extras/colour";
    colour.kind = CurveTarget::joint;
    colour.target = 0;
    colour.components = 3;
    colour.values = colours;
    Node clip =
        clip_node({"clip", 0.0f, 1.0f, false, {{TrackPath::translation, 0, 3, {0.0f, 1.0f}, {0, 0, 0, 1, 0, 0}}}});
    clip.children.push_back(make_leaf(FourCC("CURV"), write_curve(glow)));
    clip.children.push_back(make_leaf(FourCC("CURV"), write_curve(colour)));
    ModelSpec spec;
    JointSpec joint;
    joint.rest = moved(0, 0, 0);
    spec.joints = {joint};
    spec.more = {clip};
    return build_file(spec);
}

TEST(CCurve, CountsFindsAndTells) {
    const ModelHandle model = open_copy(file_with_curves());
    EXPECT_EQ(bendy_curve_count(model.get(), 0), 2u);
    EXPECT_EQ(bendy_curve_count(model.get(), 1), 0u);
    EXPECT_EQ(bendy_curve_count(nullptr, 0), 0u);
    bendy_error error = BENDY_ERROR_INIT;
    EXPECT_EQ(bendy_find_curve(model.get(), 0, "Glow", &error), 0u);
    EXPECT_EQ(bendy_find_curve(model.get(), 0, "extras/colour", &error), 1u);
    EXPECT_EQ(bendy_find_curve(model.get(), 0, "none", &error), BENDY_NONE);
    EXPECT_EQ(error.status, BENDY_NOT_FOUND);
    EXPECT_STREQ(error.message, "the clip has no curve \"none\", by name or by path");
    auto curve = sized<bendy_curve>();
    ASSERT_EQ(bendy_get_curve(model.get(), 0, 1, &curve, nullptr), BENDY_OK);
    EXPECT_EQ(curve.components, 3u);
    EXPECT_STREQ(curve.name, "");
    EXPECT_STREQ(curve.path, "extras/colour");
    EXPECT_EQ(curve.target_kind, static_cast<std::uint32_t>(BENDY_CURVE_JOINT));
    EXPECT_EQ(curve.target, 0u);
    EXPECT_EQ(curve.start, 0.0f);
    EXPECT_EQ(curve.end, 1.0f);
    ASSERT_EQ(bendy_get_curve(model.get(), 0, 0, &curve, nullptr), BENDY_OK);
    EXPECT_EQ(curve.target_kind, static_cast<std::uint32_t>(BENDY_CURVE_NOTHING));
    EXPECT_EQ(curve.target, BENDY_NONE);
}

TEST(CCurve, Samples) {
    const ModelHandle model = open_copy(file_with_curves());
    std::array<float, 4> values{9, 9, 9, 9};
    ASSERT_EQ(bendy_sample_curve(model.get(), 0, 1, 0.5, values.data(), values.size(), nullptr), BENDY_OK);
    EXPECT_EQ(values, (std::array<float, 4>{0.5f, 1, 2, 9}));
    ASSERT_EQ(bendy_sample_curve(model.get(), 0, 0, -7.0, values.data(), 1, nullptr), BENDY_OK);
    EXPECT_EQ(values[0], 3.0f);
}

TEST(CCurve, BadArgumentsAreErrors) {
    const ModelHandle model = open_copy(file_with_curves());
    std::array<float, 3> values{};
    bendy_error error = BENDY_ERROR_INIT;
    auto curve = sized<bendy_curve>();
    EXPECT_EQ(bendy_sample_curve(nullptr, 0, 0, 0, values.data(), 3, &error), BENDY_BAD_ARGUMENT);
    EXPECT_EQ(bendy_sample_curve(model.get(), 1, 0, 0, values.data(), 3, &error), BENDY_BAD_ARGUMENT);
    EXPECT_EQ(bendy_sample_curve(model.get(), 0, 2, 0, values.data(), 3, &error), BENDY_BAD_ARGUMENT);
    EXPECT_EQ(bendy_sample_curve(model.get(), 0, 1, 0, nullptr, 3, &error), BENDY_BAD_ARGUMENT);
    EXPECT_EQ(bendy_sample_curve(model.get(), 0, 1, 0, values.data(), 2, &error), BENDY_BAD_ARGUMENT);
    EXPECT_EQ(std::string(error.message), "values has room for 2, 3 are needed");
    EXPECT_EQ(bendy_sample_curve(model.get(), 0, 1, std::nan(""), values.data(), 3, &error), BENDY_BAD_ARGUMENT);
    EXPECT_EQ(bendy_get_curve(model.get(), 0, 2, &curve, &error), BENDY_BAD_ARGUMENT);
    EXPECT_EQ(bendy_get_curve(model.get(), 0, 0, nullptr, &error), BENDY_BAD_ARGUMENT);
    curve.size = 4;
    EXPECT_EQ(bendy_get_curve(model.get(), 0, 0, &curve, &error), BENDY_BAD_ARGUMENT);
    EXPECT_EQ(bendy_find_curve(model.get(), 0, nullptr, &error), BENDY_NONE);
    EXPECT_EQ(bendy_find_curve(model.get(), 7, "Glow", &error), BENDY_NONE);
    EXPECT_EQ(bendy_find_curve(nullptr, 0, "Glow", &error), BENDY_NONE);
}

}  // namespace
}  // namespace bendy::test::curve_test
