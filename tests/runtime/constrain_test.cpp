#include <bendy/runtime/constrain.h>

#include "runtime/build_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

// What is legal is said here a second time, with the mathematical library and straight from spec/constraints.md.
namespace bendy {
namespace {

constexpr double kPi = M_PI;
constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr int kRotations = 20000;

double angle_of(const glm::dquat& a, const glm::dquat& b) {
    const glm::dquat d = glm::conjugate(a) * b;
    return 2.0 * std::atan2(std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z), std::abs(d.w));
}

/// The distance of an angle from a range on the circle; 0 inside.
double outside(double angle, double low, double high) {
    if (high - low >= 2.0 * kPi) return 0.0;
    double best = kPi;
    for (int turns = -3; turns <= 3; ++turns) {
        const double a = angle + turns * 2.0 * kPi;
        best = std::min(best, std::max({0.0, low - a, a - high}));
    }
    return best;
}

/// About how far outside, in radians; 0 inside.
double illegality(const LimitRecord& limit, const glm::dquat& R) {
    const auto& low = limit.rotation_min;
    const auto& high = limit.rotation_max;
    const double angle = angle_of(R, glm::dquat(1, 0, 0, 0));
    switch (static_cast<LimitModel>(limit.model)) {
        case LimitModel::free: return 0.0;
        case LimitModel::locked: return angle;
        case LimitModel::hinge:
            return std::max({std::abs(R.y), std::abs(R.z), outside(2.0 * std::atan2(R.x, R.w), low[0], high[0])});
        case LimitModel::largest_angle: return std::max(0.0, angle - high[0]);
        case LimitModel::euler_box: {
            constexpr std::array<std::array<int, 3>, 6> kOrders{
                {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
            const auto [i, j, k] = kOrders[limit.euler_order];
            const double sign = (j - i + 3) % 3 == 1 ? 1.0 : -1.0;
            const glm::dmat3 m = glm::mat3_cast(R);  // m[column][row]; R = K J I
            // In row k of K J I only J and I are left: its entry i is -sign sin(j), j sin(i) cos(j) sign, k cos cos.
            const double second = std::asin(std::clamp(-sign * m[i][k], -1.0, 1.0));
            const double first = std::atan2(sign * m[j][k], m[k][k]);
            const double third = std::atan2(sign * m[i][j], m[i][i]);
            const auto off = [&](double a, double b, double c) {
                return std::max({outside(a, low[static_cast<std::size_t>(i)], high[static_cast<std::size_t>(i)]),
                                 outside(b, low[static_cast<std::size_t>(j)], high[static_cast<std::size_t>(j)]),
                                 outside(c, low[static_cast<std::size_t>(k)], high[static_cast<std::size_t>(k)])});
            };
            return std::min(off(first, second, third), off(first + kPi, kPi - second, third + kPi));
        }
        default: break;
    }
    const double length = std::hypot(R.w, R.x);
    const glm::dquat twist = length < 1e-12 ? glm::dquat(1, 0, 0, 0) : glm::dquat(R.w / length, R.x / length, 0, 0);
    glm::dquat swing = R * glm::conjugate(twist);
    if (swing.w < 0.0) swing = -swing;
    const double off_twist = outside(2.0 * std::atan2(twist.x, twist.w), low[0], high[0]);
    const auto side = [&](std::size_t axis, double s) { return s < 0.0 ? -double{low[axis]} : double{high[axis]}; };
    const double limit_y = std::min(side(1, swing.y), kPi);
    const double limit_z = std::min(side(2, swing.z), kPi);
    if (static_cast<LimitModel>(limit.model) == LimitModel::swing_twist_pyramid) {
        const double off_y = std::abs(2.0 * std::atan2(swing.y, swing.w)) - limit_y;
        const double off_z = std::abs(2.0 * std::atan2(swing.z, swing.w)) - limit_z;
        return std::max({off_twist, off_y, off_z, 0.0});
    }
    // An infinite limit leaves its axis out.
    const double a = std::isinf(side(1, swing.y)) ? 1e9 : std::sin(limit_y / 2.0);
    const double b = std::isinf(side(2, swing.z)) ? 1e9 : std::sin(limit_z / 2.0);
    if (a < 1e-12 || b < 1e-12) {
        return std::max({off_twist, std::abs(swing.y) - a, std::abs(swing.z) - b, 0.0});
    }
    const double r = std::hypot(swing.y / a, swing.z / b);
    return std::max({off_twist, (r - 1.0) * std::min(a, b), 0.0});
}

struct Case {
    std::string name;
    LimitRecord limit;
};

LimitRecord make_limit(LimitModel model, std::array<double, 3> low, std::array<double, 3> high,
                       EulerOrder order = EulerOrder::xyz) {
    LimitRecord limit;
    limit.model = static_cast<std::uint8_t>(model);
    limit.euler_order = static_cast<std::uint8_t>(order);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        limit.rotation_min[axis] = static_cast<float>(low[axis] * kPi / 180.0);
        limit.rotation_max[axis] = static_cast<float>(high[axis] * kPi / 180.0);
    }
    return limit;
}

std::vector<Case> all_cases() {
    using enum LimitModel;
    return {
        {"Free", make_limit(free, {0, 0, 0}, {0, 0, 0})},
        {"Locked", make_limit(locked, {0, 0, 0}, {0, 0, 0})},
        {"Knee", make_limit(hinge, {0, 0, 0}, {150, 0, 0})},
        {"HingeAcrossPi", make_limit(hinge, {120, 0, 0}, {250, 0, 0})},
        {"Cone", make_limit(swing_twist_ellipse, {-30, -40, -40}, {30, 40, 40})},
        {"Shoulder", make_limit(swing_twist_ellipse, {-70, -100, -35}, {90, 60, 130})},
        {"WideEllipse", make_limit(swing_twist_ellipse, {-170, -179, -20}, {175, 180, 20})},
        {"OneSided", make_limit(swing_twist_ellipse, {0, 0, -45}, {0, 90, 0})},
        {"FreeTwist", make_limit(swing_twist_ellipse, {-400, -25, -50}, {400, 25, 50})},
        {"Band", make_limit(swing_twist_ellipse, {-30, -25, -kInf}, {30, 40, kInf})},
        {"HalfBand", make_limit(swing_twist_ellipse, {-kInf, -kInf, -20}, {kInf, 60, 70})},
        {"Pyramid", make_limit(swing_twist_pyramid, {-20, -30, -60}, {45, 50, 20})},
        {"WidePyramid", make_limit(swing_twist_pyramid, {-100, -180, -90}, {10, 180, 120})},
        {"FlatPyramid", make_limit(swing_twist_pyramid, {-10, 0, -70}, {10, 0, 70})},
        {"Box", make_limit(euler_box, {-40, -30, -20}, {40, 30, 60})},
        {"BoxZyx", make_limit(euler_box, {-100, -20, -45}, {10, 70, 45}, EulerOrder::zyx)},
        {"BoxYxz", make_limit(euler_box, {-25, -35, -20}, {30, 35, 20}, EulerOrder::yxz)},
        {"BoxOneAxis", make_limit(euler_box, {0, 0, 0}, {80, 0, 0}, EulerOrder::yzx)},
        {"BoxFreeAxis", make_limit(euler_box, {-1000, -10, -10}, {1000, 10, 10}, EulerOrder::xzy)},
        {"BoxWide", make_limit(euler_box, {-170, -100, -170}, {170, 100, 120}, EulerOrder::zxy)},
        {"LargestAngle", make_limit(largest_angle, {0, 0, 0}, {60, 0, 0})},
    };
}

Constraint prepared(const LimitRecord& limit) {
    return make_constraint({0, 0, limit});
}

glm::dquat random_rotation(std::mt19937& random) {
    std::normal_distribution<double> normal;
    return glm::normalize(glm::dquat(normal(random), normal(random), normal(random), normal(random)));
}

/// A rotation within `size` radians, roughly.
glm::dquat small_rotation(std::mt19937& random, double size) {
    std::uniform_real_distribution<double> uniform(-size / 2.0, size / 2.0);
    return glm::normalize(glm::dquat(1.0, uniform(random), uniform(random), uniform(random)));
}

class ConstrainCase : public testing::TestWithParam<Case> {};

TEST_P(ConstrainCase, RandomRotationsComeInsideStayThereAndWhatIsInsideStaysAsItIs) {
    const LimitRecord& limit = GetParam().limit;
    const Constraint constraint = prepared(limit);
    std::mt19937 random(7);
    int inside = 0;
    for (int i = 0; i < kRotations; ++i) {
        // Half of them anywhere, half of them near the rest pose, where legal ones are.
        const glm::dquat R = i % 2 == 0 ? random_rotation(random) : small_rotation(random, 2.0);
        const glm::dquat legal = clamp_rotation(constraint, R);
        ASSERT_NEAR(glm::length(legal), 1.0, 1e-12);
        ASSERT_LE(illegality(limit, legal), 2e-7) << i;
        ASSERT_EQ(clamp_rotation(constraint, legal), legal) << i;
        if (illegality(limit, R) <= 1e-12) {
            ++inside;
            ASSERT_EQ(legal, R) << i;
        }
    }
    const auto model = static_cast<LimitModel>(limit.model);
    const bool has_volume = model != LimitModel::locked && model != LimitModel::hinge && GetParam().name != "OneSided" &&
                            GetParam().name != "FlatPyramid" && GetParam().name != "BoxOneAxis";
    EXPECT_TRUE(!has_volume || inside > kRotations / 1000) << inside;
}

TEST_P(ConstrainCase, NoLegalRotationIsNearer) {
    const LimitRecord& limit = GetParam().limit;
    const Constraint constraint = prepared(limit);
    std::mt19937 random(11);
    // Legal rotations all over the range: the brought-back forms of random ones.
    std::vector<glm::dquat> legal;
    for (int i = 0; i < 3000; ++i)
        legal.push_back(clamp_rotation(constraint, i % 3 == 0 ? random_rotation(random) : small_rotation(random, 3.0)));
    for (int i = 0; i < 3000; ++i) {
        const glm::dquat R = i % 2 == 0 ? random_rotation(random) : small_rotation(random, 3.0);
        const glm::dquat found = clamp_rotation(constraint, R);
        const double distance = angle_of(found, R);
        for (const glm::dquat& other : legal) ASSERT_LE(distance, angle_of(other, R) + 1e-6) << i;
        for (const double size : {0.3, 0.03, 0.003}) {  // and close by
            for (int near = 0; near < 10; ++near) {
                const glm::dquat other = clamp_rotation(constraint, found * small_rotation(random, size));
                ASSERT_LE(distance, angle_of(other, R) + 1e-6) << i;
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Models, ConstrainCase, testing::ValuesIn(all_cases()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace bendy
