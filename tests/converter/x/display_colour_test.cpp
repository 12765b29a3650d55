#include "formats/x/conventions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace bendy::converter::x::display_colour_test {
namespace {

TEST(DisplayColour, IsTheCurveOfSrgb) {
    EXPECT_EQ(to_light(0.0f), 0.0f);
    EXPECT_EQ(to_light(1.0f), 1.0f);
    EXPECT_EQ(to_display(1.0f), 1.0f);
    for (int k = 1; k <= 300; ++k) {
        const float x = static_cast<float>(k) / 200.0f;
        const double light = x <= 0.04045f ? x / 12.92 : std::pow((static_cast<double>(x) + 0.055) / 1.055, 2.4);
        EXPECT_FLOAT_EQ(to_light(x), static_cast<float>(light));
        const double display = x <= 0.0031308f ? x * 12.92 : 1.055 * std::pow(static_cast<double>(x), 1 / 2.4) - 0.055;
        EXPECT_FLOAT_EQ(to_display(x), static_cast<float>(display));
    }
}

TEST(DisplayColour, StrangeNumbersStayWhatTheyAre) {
    constexpr float kInfinite = std::numeric_limits<float>::infinity();
    EXPECT_EQ(to_light(-2.0f), -2.0f);
    EXPECT_EQ(to_display(-2.0f), -2.0f);
    EXPECT_EQ(to_light(kInfinite), kInfinite);
    EXPECT_EQ(to_display(kInfinite), kInfinite);
    EXPECT_TRUE(std::isnan(to_light(std::numeric_limits<float>::quiet_NaN())));
    EXPECT_GT(to_light(1e30f), 1e30f);
    EXPECT_GT(to_display(1e30f), 1e10f);
    EXPECT_EQ(to_light(glm::vec4(0.5f)).w, 0.5f);
    EXPECT_EQ(to_display(glm::vec4(0.5f)).w, 0.5f);
}

}  // namespace
}  // namespace bendy::converter::x::display_colour_test
