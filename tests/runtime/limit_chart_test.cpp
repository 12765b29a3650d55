#include "ik/limit_chart.h"

#include <bendy/runtime/constrain.h>
#include <bendy/runtime/constraint.h>

#include <gtest/gtest.h>
#include <glm/gtc/quaternion.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace bendy::limit_chart_test {
namespace {

ConstraintView make(ConstraintModel model, std::array<float, 3> low, std::array<float, 3> high) {
    ConstraintView view;
    view.record.model = static_cast<std::uint8_t>(model);
    view.record.frame = {0.1f, 0.7f, 0.1f, 0.7f};
    view.record.rotation_min = low;
    view.record.rotation_max = high;
    return view;
}

std::vector<ConstraintView> limits() {
    return {make(ConstraintModel::hinge, {-0.2f, 0, 0}, {2.4f, 0, 0}),
            make(ConstraintModel::swing_twist_ellipse, {-1.5f, -2.3f, -1.2f}, {0.4f, 1.1f, 0.3f}),
            make(ConstraintModel::swing_twist_ellipse, {-0.3f, 0.0f, -0.5f}, {0.3f, 0.0f, 1.5f}),
            make(ConstraintModel::swing_twist_pyramid, {-0.5f, -0.2f, -0.6f}, {0.5f, 0.2f, 2.0f}),
            make(ConstraintModel::euler_box, {-0.4f, -0.5f, -0.6f}, {1.0f, 0.8f, 0.7f}),
            make(ConstraintModel::free, {}, {})};
}

IkLink link_of(const Constraint& constraint) {
    IkLink link;
    link.constraint = &constraint;
    link.frame = constraint.frame;
    link.rest_frame = glm::normalize(glm::dquat(0.8, 0.2, -0.5, 0.1)) * constraint.frame;
    return link;
}

glm::dquat in_limits(const IkLink& link, const glm::dquat& local) {
    return glm::conjugate(link.rest_frame) * local * link.frame;
}

glm::dquat any_rotation(std::mt19937& random) {
    std::normal_distribution<double> number;
    double parts[4];
    for (double& part : parts) part = number(random);
    return glm::normalize(glm::dquat(parts[0], parts[1], parts[2], parts[3]));
}

glm::dvec3 turn_of(const glm::dquat& q) {
    return (q.w < 0.0 ? -2.0 : 2.0) * glm::dvec3(q.x, q.y, q.z);  // of a small rotation
}

/// Calls a function with a link of each kind of limits in random legal rotations.
template <class Function>
void visit(const Function& function) {
    std::mt19937 random(4);
    for (const ConstraintView& view : limits()) {
        const Constraint constraint = make_constraint(view);
        for (int i = 0; i < 200; ++i) {
            IkLink link = link_of(constraint);
            const glm::dquat R = clamp_rotation(constraint, any_rotation(random));
            link.local = link.rest_frame * R * glm::conjugate(link.frame);
            LimitChart chart;
            ASSERT_TRUE(chart.begin(link));
            chart.read(link);
            function(constraint, link, chart, random);
        }
    }
}

TEST(LimitChart, ReadsAndReturnsTheSameRotation) {
    visit([](const Constraint& constraint, const IkLink& link, LimitChart& chart, std::mt19937&) {
        const glm::dquat same = chart.move({});
        EXPECT_LT(glm::length(turn_of(glm::conjugate(link.local) * same)), 1e-6)
            << static_cast<int>(constraint.model());
    });
}

TEST(LimitChart, NumbersTurnTheLinkAboutTheirAxes) {
    visit([](const Constraint& constraint, const IkLink&, LimitChart& chart, std::mt19937& random) {
        // Away from the limits, which would stop a step.
        std::uniform_real_distribution<double> share(0.3, 0.7);
        LimitChart::Numbers inside{};
        for (std::size_t n = 0; n < chart.size(); ++n) {
            const double low = std::max(chart.low()[n], -1.0), high = std::min(chart.high()[n], 1.0);
            inside[n] = low + share(random) * (high - low);
            if (constraint.model() == ConstraintModel::free) inside[n] = 0.0;
        }
        chart.set(inside);
        const glm::dquat before = chart.move({});
        const auto axes = chart.axes();
        for (std::size_t n = 0; n < chart.size(); ++n) {
            if (chart.low()[n] == chart.high()[n]) continue;
            constexpr double kStep = 1e-5;
            LimitChart::Numbers step{};
            step[n] = kStep;
            chart.set(inside);
            const glm::dvec3 turn = turn_of(chart.move(step) * glm::conjugate(before)) / kStep;
            EXPECT_LT(glm::length(turn - chart.basis() * axes[n]), 1e-4 * (1.0 + glm::length(turn)))
                << static_cast<int>(constraint.model()) << ' ' << n;
        }
    });
}

TEST(LimitChart, NoStepLeavesTheLimits) {
    visit([](const Constraint& constraint, const IkLink& link, LimitChart& chart, std::mt19937& random) {
        std::normal_distribution<double> number(0.0, 2.0);
        LimitChart::Numbers step{};
        for (double& value : step) value = number(random);
        const glm::dquat moved = chart.move(step);
        EXPECT_LT(violation(constraint, in_limits(link, moved)), 1e-6) << static_cast<int>(constraint.model());
    });
}

TEST(LimitChart, KnowsTheEdgeOfAnEllipse) {
    const Constraint constraint = make_constraint(limits()[1]);
    IkLink link = link_of(constraint);
    link.local = link.rest_frame * glm::conjugate(link.frame);
    LimitChart chart;
    ASSERT_TRUE(chart.begin(link));
    chart.read(link);
    EXPECT_FALSE(chart.edge().is_there);
    (void)chart.move({3.0, 0.2, 0.0});
    const LimitChart::Edge edge = chart.edge();
    ASSERT_TRUE(edge.is_there);
    const LimitChart::Numbers at = chart.values();
    // A step along the edge leaves it by its curvature only, a step inward leaves it.
    constexpr double kStep = 1e-3;
    (void)chart.move({-kStep * edge.z, kStep * edge.y, 0.0});
    const double off = (chart.values()[0] - at[0]) * edge.y + (chart.values()[1] - at[1]) * edge.z;
    EXPECT_NEAR(off, -0.5 * edge.curvature * kStep * kStep, 0.1 * edge.curvature * kStep * kStep);
    chart.set(at);
    (void)chart.move({-kStep * edge.y, -kStep * edge.z, 0.0});
    EXPECT_FALSE(chart.edge().is_there);
}

TEST(LimitChart, LeavesOtherLimitsToOtherSolvers) {
    ConstraintView soft = limits()[0];
    soft.record.soft_zone = 0.1f;
    for (const ConstraintView& view : {soft, make(ConstraintModel::largest_angle, {}, {1.0f, 0.0f, 0.0f})}) {
        const Constraint constraint = make_constraint(view);
        LimitChart chart;
        EXPECT_FALSE(chart.begin(link_of(constraint)));
    }
}

}  // namespace
}  // namespace bendy::limit_chart_test
