#include "compact/lanes.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>

namespace bendy::converter {
namespace {

Several several(const std::array<double, kSeveral>& numbers) {
    Several lanes{};
    for (std::size_t k = 0; k < kSeveral; ++k) set_lane(lanes, k, numbers.at(k));
    return lanes;
}

bool is_same(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

/// Numbers of many sizes, also zeros.
class Numbers {
public:
    double next() {
        const int kind = std::uniform_int_distribution(0, 9)(random_);
        if (kind == 0) return 0.0;
        const double size = std::pow(10.0, std::uniform_real_distribution(-12.0, 1.0)(random_));
        return kind % 2 == 0 ? size : -size;
    }
    std::array<double, kSeveral> row() {
        std::array<double, kSeveral> numbers{};
        for (double& number : numbers) number = next();
        return numbers;
    }

private:
    std::mt19937 random_{5};
};

TEST(Lanes, AnglesAreThoseOfADouble) {
    Numbers numbers;
    for (int turn = 0; turn < 20'000; ++turn) {
        auto y = numbers.row();
        auto x = numbers.row();
        for (std::size_t k = 0; k < kSeveral; ++k) {
            y.at(k) = std::abs(y.at(k));
            x.at(k) = std::abs(x.at(k));
            if (y.at(k) == 0.0 && x.at(k) == 0.0) x.at(k) = 1.0;
        }
        const Several angles = atan2(several(y), several(x));
        for (std::size_t k = 0; k < kSeveral; ++k)
            ASSERT_TRUE(is_same(lane(angles, k), trig::atan2(y.at(k), x.at(k)))) << y.at(k) << ' ' << x.at(k);
    }
}

TEST(Lanes, RotationsAreThoseOfPackedRotation) {
    Numbers numbers;
    for (int turn = 0; turn < 20'000; ++turn) {
        const auto x = numbers.row();
        const auto y = numbers.row();
        const auto z = numbers.row();
        const glm::qua<Several> found = packed_turn(glm::vec<3, Several>(several(x), several(y), several(z)));
        for (std::size_t k = 0; k < kSeveral; ++k) {
            const auto q = packed_rotation({x.at(k), y.at(k), z.at(k)});
            ASSERT_TRUE(is_same(lane(found.x, k), q[0]) && is_same(lane(found.y, k), q[1]) &&
                        is_same(lane(found.z, k), q[2]) && is_same(lane(found.w, k), q[3]))
                << x.at(k) << ' ' << y.at(k) << ' ' << z.at(k);
        }
    }
}

TEST(Lanes, WholeNumbersAreRoundedToEvenOnesAndHeld) {
    for (const double number : {0.0, 0.5, -0.5, 1.5, 2.5, -2.5, 3.49, 1e9 + 0.5, 2.1e9, -7e12, INFINITY}) {
        const double expected = std::clamp(std::nearbyint(number), -2e9, 2e9);
        EXPECT_EQ(lane(whole(Several(number)), kSeveral - 1), expected) << number;
        EXPECT_EQ(whole(number), expected) << number;
    }
}

}  // namespace
}  // namespace bendy::converter
