#include <bendy/runtime/constrain.h>

#include "math/nearest_rotation.h"
#include "runtime/build_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <string_view>
#include <vector>

// What is legal is said here a second time, with the mathematical library and straight from spec/constraints.md.
namespace bendy::constrain_test {
namespace {

constexpr double kPi = M_PI;
constexpr float kInf = std::numeric_limits<float>::infinity();
/// Random rotations per model, all its cases together.
#ifdef NDEBUG
constexpr int kRotations = 1'000'000;
#else
constexpr int kRotations = 20'000;
#endif

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
double illegality(const ConstraintRecord& constraint, const glm::dquat& R) {
    const auto& low = constraint.rotation_min;
    const auto& high = constraint.rotation_max;
    const double angle = angle_of(R, glm::dquat(1, 0, 0, 0));
    switch (static_cast<ConstraintModel>(constraint.model)) {
        case ConstraintModel::free:
            return 0.0;
        case ConstraintModel::locked:
            return angle;
        case ConstraintModel::hinge:
            return std::max({std::abs(R.y), std::abs(R.z), outside(2.0 * std::atan2(R.x, R.w), low[0], high[0])});
        case ConstraintModel::largest_angle:
            return std::max(0.0, angle - high[0]);
        case ConstraintModel::euler_box: {
            constexpr std::array<std::array<int, 3>, 6> kOrders{
                {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
            const std::array<int, 3> order = kOrders[constraint.euler_order];
            const int i = order[0], j = order[1], k = order[2];
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
        default:
            break;
    }
    const double length = std::hypot(R.w, R.x);
    const glm::dquat twist = length < 1e-12 ? glm::dquat(1, 0, 0, 0) : glm::dquat(R.w / length, R.x / length, 0, 0);
    glm::dquat swing = R * glm::conjugate(twist);
    if (swing.w < 0.0) swing = -swing;
    const double off_twist = outside(2.0 * std::atan2(twist.x, twist.w), low[0], high[0]);
    const auto side = [&](std::size_t axis, double s) { return s < 0.0 ? -double{low[axis]} : double{high[axis]}; };
    const double limit_y = std::min(side(1, swing.y), kPi);
    const double limit_z = std::min(side(2, swing.z), kPi);
    if (static_cast<ConstraintModel>(constraint.model) == ConstraintModel::swing_twist_pyramid) {
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
    ConstraintRecord constraint;
};

ConstraintRecord make_constraint_record(ConstraintModel model, std::array<double, 3> low, std::array<double, 3> high,
                                        EulerOrder order = EulerOrder::xyz) {
    ConstraintRecord constraint;
    constraint.model = static_cast<std::uint8_t>(model);
    constraint.euler_order = static_cast<std::uint8_t>(order);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        constraint.rotation_min[axis] = static_cast<float>(low[axis] * kPi / 180.0);
        constraint.rotation_max[axis] = static_cast<float>(high[axis] * kPi / 180.0);
    }
    return constraint;
}

std::vector<Case> all_cases() {
    using enum ConstraintModel;
    return {
        {"Free", make_constraint_record(free, {0, 0, 0}, {0, 0, 0})},
        {"Locked", make_constraint_record(locked, {0, 0, 0}, {0, 0, 0})},
        {"Knee", make_constraint_record(hinge, {0, 0, 0}, {150, 0, 0})},
        {"HingeAcrossPi", make_constraint_record(hinge, {120, 0, 0}, {250, 0, 0})},
        {"Cone", make_constraint_record(swing_twist_ellipse, {-30, -40, -40}, {30, 40, 40})},
        {"Shoulder", make_constraint_record(swing_twist_ellipse, {-70, -100, -35}, {90, 60, 130})},
        {"WideEllipse", make_constraint_record(swing_twist_ellipse, {-170, -179, -20}, {175, 180, 20})},
        {"OneSided", make_constraint_record(swing_twist_ellipse, {0, 0, -45}, {0, 90, 0})},
        {"FreeTwist", make_constraint_record(swing_twist_ellipse, {-400, -25, -50}, {400, 25, 50})},
        {"Band", make_constraint_record(swing_twist_ellipse, {-30, -25, -kInf}, {30, 40, kInf})},
        {"HalfBand", make_constraint_record(swing_twist_ellipse, {-kInf, -kInf, -20}, {kInf, 60, 70})},
        {"Pyramid", make_constraint_record(swing_twist_pyramid, {-20, -30, -60}, {45, 50, 20})},
        {"WidePyramid", make_constraint_record(swing_twist_pyramid, {-100, -180, -90}, {10, 180, 120})},
        {"FlatPyramid", make_constraint_record(swing_twist_pyramid, {-10, 0, -70}, {10, 0, 70})},
        {"Box", make_constraint_record(euler_box, {-40, -30, -20}, {40, 30, 60})},
        {"BoxZyx", make_constraint_record(euler_box, {-100, -20, -45}, {10, 70, 45}, EulerOrder::zyx)},
        {"BoxYxz", make_constraint_record(euler_box, {-25, -35, -20}, {30, 35, 20}, EulerOrder::yxz)},
        {"BoxOneAxis", make_constraint_record(euler_box, {0, 0, 0}, {80, 0, 0}, EulerOrder::yzx)},
        {"BoxFreeAxis", make_constraint_record(euler_box, {-1000, -10, -10}, {1000, 10, 10}, EulerOrder::xzy)},
        {"BoxWide", make_constraint_record(euler_box, {-170, -100, -170}, {170, 100, 120}, EulerOrder::zxy)},
        {"LargestAngle", make_constraint_record(largest_angle, {0, 0, 0}, {60, 0, 0})},
    };
}

Constraint prepared(const ConstraintRecord& constraint) {
    return make_constraint({0, 0, constraint});
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

/// How many of the model's rotations fall to each of its cases.
int rotations_of(const ConstraintRecord& constraint) {
    const std::vector<Case> cases = all_cases();
    const auto same = std::count_if(cases.begin(), cases.end(),
                                    [&](const Case& c) { return c.constraint.model == constraint.model; });
    return kRotations / static_cast<int>(same) + 1;
}

/// Half of them anywhere, half of them near the rest pose, where legal ones are.
glm::dquat some_rotation(std::mt19937& random, int i) {
    return i % 2 == 0 ? random_rotation(random) : small_rotation(random, 2.0);
}

class ConstrainCase : public testing::TestWithParam<Case> {
protected:
    [[nodiscard]] const ConstraintRecord& record() const { return GetParam().constraint; }

    [[nodiscard]] glm::dquat quickly_clamped(const Constraint& c, const glm::dquat& R) const {
        return quick_legal_rotation(c, c.shape, R);
    }

    /// Whether a share of all rotations is legal.
    [[nodiscard]] bool has_volume() const {
        constexpr std::array<std::string_view, 6> kFlat{"Locked",   "Knee",        "HingeAcrossPi",
                                                        "OneSided", "FlatPyramid", "BoxOneAxis"};
        return std::find(kFlat.begin(), kFlat.end(), GetParam().name) == kFlat.end();
    }
};

TEST_P(ConstrainCase, RandomRotationsComeInsideStayThereAndWhatIsInsideStaysAsItIs) {
    const Constraint constraint = prepared(record());
    const int count = rotations_of(record());
    std::mt19937 random(7);
    int inside = 0;
    for (int i = 0; i < count; ++i) {
        const glm::dquat R = some_rotation(random, i);
        const glm::dquat legal = clamp_rotation(constraint, R);
        ASSERT_NEAR(glm::length(legal), 1.0, 1e-12);
        ASSERT_LE(illegality(record(), legal), 2e-7) << i;
        ASSERT_EQ(clamp_rotation(constraint, legal), legal) << i;
        if (illegality(record(), R) <= 1e-12) {
            ++inside;
            ASSERT_EQ(legal, R) << i;
        }
    }
    EXPECT_TRUE(!has_volume() || inside > count / 1000) << inside;
}

// What solvers clamp with.
TEST_P(ConstrainCase, TheQuickClampComesInsideAndStaysThereAndWhatIsInsideStaysAsItIs) {
    const Constraint constraint = prepared(record());
    const int count = rotations_of(record());
    std::mt19937 random(13);
    int inside = 0;
    for (int i = 0; i < count; ++i) {
        const glm::dquat R = some_rotation(random, i);
        const glm::dquat legal = quickly_clamped(constraint, R);
        ASSERT_NEAR(glm::length(legal), 1.0, 1e-12);
        ASSERT_LE(illegality(record(), legal), 2e-7) << i;
        ASSERT_LE(angle_of(quickly_clamped(constraint, legal), legal), 1e-9) << i;
        if (illegality(record(), R) <= 1e-12) {
            ++inside;
            ASSERT_LE(angle_of(legal, R), 1e-12) << i;
        }
    }
    EXPECT_TRUE(!has_volume() || inside > count / 1000) << inside;
}

/// Of the constraints that are not hollow, as those wider than half a turn are.
using FullConstrainCase = ConstrainCase;

TEST_P(FullConstrainCase, SmallStepsNearTheBoundaryMakeSmallSteps) {
    constexpr double kStep = 1e-5;  // radians
    const Constraint constraint = prepared(record());
    std::mt19937 random(17);
    double largest = 0.0;
    for (int i = 0; i < 2000; ++i) {
        const glm::dquat R = clamp_rotation(constraint, some_rotation(random, i)) * small_rotation(random, 0.1);
        const glm::dquat beside = R * small_rotation(random, kStep);
        const double moved = angle_of(clamp_rotation(constraint, R), clamp_rotation(constraint, beside));
        largest = std::max(largest, moved / angle_of(R, beside));
    }
    RecordProperty("largest", std::to_string(largest));
    EXPECT_LE(largest, 1.5);
}

TEST_P(ConstrainCase, NoLegalRotationIsNearer) {
    const Constraint constraint = prepared(record());
    std::mt19937 random(11);
    // Legal rotations all over the range: the brought-back forms of random ones.
    std::vector<glm::dquat> legal;
    for (int i = 0; i < 3000; ++i)
        legal.push_back(clamp_rotation(constraint, i % 3 == 0 ? random_rotation(random) : small_rotation(random, 3.0)));
    for (int i = 0; i < 2000; ++i) {
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

std::string name_of(const testing::TestParamInfo<Case>& test) {
    return test.param.name;
}

std::vector<Case> full_cases() {
    constexpr std::array<std::string_view, 3> kHollow{"WideEllipse", "WidePyramid", "BoxWide"};
    std::vector<Case> cases = all_cases();
    cases.erase(std::remove_if(cases.begin(), cases.end(),
                               [&](const Case& one) {
                                   return std::find(kHollow.begin(), kHollow.end(), one.name) != kHollow.end();
                               }),
                cases.end());
    return cases;
}

INSTANTIATE_TEST_SUITE_P(Models, ConstrainCase, testing::ValuesIn(all_cases()), name_of);
INSTANTIATE_TEST_SUITE_P(Models, FullConstrainCase, testing::ValuesIn(full_cases()), name_of);

/// Follows R(angle) from 0 to 4 pi; returns the largest step of what it is clamped to by the step of R.
template <class Path>
double largest_step(const Constraint& constraint, const Path& R) {
    constexpr int kSteps = 5000;
    glm::dquat last = clamp_rotation(constraint, R(0.0));
    double largest = 0.0;
    for (int i = 1; i <= kSteps; ++i) {
        const glm::dquat now = clamp_rotation(constraint, R(4.0 * kPi * i / kSteps));
        largest = std::max(largest, angle_of(last, now) * kSteps / (4.0 * kPi));
        last = now;
    }
    return largest;
}

glm::dquat turn(double angle, const glm::dvec3& axis) {
    return glm::angleAxis(angle, glm::normalize(axis));
}

TEST(Constrain, NothingJumpsAtPi) {
    using enum ConstraintModel;
    const auto about_x = [](double angle) { return turn(angle, {1, 0, 0}); };
    // Through pi, there and back, inside the range and beyond its ends, but not as far as where the other end is
    // nearer.
    const auto there_and_back = [&](double angle) { return about_x(kPi + 1.8 * std::sin(angle)); };
    const Constraint hinged = prepared(make_constraint_record(hinge, {120, 0, 0}, {250, 0, 0}));
    EXPECT_LE(largest_step(hinged, there_and_back), 1.81);
    const Constraint free_hinge = prepared(make_constraint_record(hinge, {-180, 0, 0}, {180, 0, 0}));
    EXPECT_LE(largest_step(free_hinge, about_x), 1.01);
    for (const double swing : {0.0, 0.5, 0.9, 1.4}) {  // inside and outside
        const glm::dquat bent = turn(swing, {0, 0.6, 0.8});
        const auto twisted = [&](double angle) { return bent * about_x(angle); };
        const auto twisted_back = [&](double angle) { return bent * there_and_back(angle); };
        for (const ConstraintModel model : {swing_twist_ellipse, swing_twist_pyramid}) {
            const Constraint free_twist = prepared(make_constraint_record(model, {-200, -50, -40}, {200, 35, 60}));
            EXPECT_LE(largest_step(free_twist, twisted), 1.6) << swing;
            const Constraint across = prepared(make_constraint_record(model, {100, -50, -40}, {260, 35, 60}));
            EXPECT_LE(largest_step(across, twisted_back), 2.5) << swing;
        }
    }
    const Constraint box = prepared(make_constraint_record(euler_box, {100, -40, -30}, {260, 40, 30}));
    EXPECT_LE(largest_step(box, there_and_back), 1.81);
}

}  // namespace
}  // namespace bendy::constrain_test
