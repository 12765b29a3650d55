#include <bendy/format/trig.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace bendy {
namespace {

TEST(Trig, CubeRootIsNearThatOfTheLibrary) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> exponent(-300.0, 300.0);
    for (int round = 0; round < 100'000; ++round) {
        const double x = std::pow(10.0, exponent(random)) * (round % 2 == 0 ? 1.0 : -1.0);
        const long double root = std::cbrt(static_cast<long double>(x));
        ASSERT_LE(std::abs(trig::cube_root(x) - root), 2.3e-16L * std::abs(root)) << x;
    }
}

TEST(Trig, CubeRootOfWhatHasNone) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(trig::cube_root(0.0), 0.0);
    EXPECT_TRUE(std::signbit(trig::cube_root(-0.0)));
    EXPECT_EQ(trig::cube_root(-kInfinity), -kInfinity);
    EXPECT_TRUE(std::isnan(trig::cube_root(std::numeric_limits<double>::quiet_NaN())));
    EXPECT_EQ(trig::cube_root(27.0), 3.0);
    EXPECT_NEAR(trig::cube_root(std::numeric_limits<double>::denorm_min()),
                std::cbrt(std::numeric_limits<double>::denorm_min()), 1e-120);
}

}  // namespace
}  // namespace bendy
