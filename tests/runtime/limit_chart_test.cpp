#include "pose/ik_link.h"

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
            make(ConstraintModel::largest_angle, {}, {1.0f, 0, 0}),
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
            chart.begin(link);
            (void)chart.read(link, link.local);
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

TEST(LimitChart, FollowsTheEdgeOfAnEllipseAndOfTheLargestAngle) {
    for (const std::size_t which : {1u, 5u}) {
        const Constraint constraint = make_constraint(limits()[which]);
        IkLink link = link_of(constraint);
        link.local = link.rest_frame * glm::conjugate(link.frame);
        LimitChart chart;
        chart.begin(link);
        (void)chart.read(link, link.local);
        EXPECT_FALSE(chart.ways()[0].is_at_high);
        (void)chart.move({3.0, 0.2, 0.0});
        const auto ways = chart.ways();
        ASSERT_TRUE(ways[0].is_at_high);
        EXPECT_TRUE(ways[0].is_stopped(-1.0));
        EXPECT_FALSE(ways[0].is_stopped(1.0));
        const LimitChart::Numbers at = chart.values();
        // A step along the edge leaves it by its curvature only, a step inward leaves it.
        constexpr double kStep = 1e-3;
        const auto go = [&](const LimitChart::Numbers& way, double step) {
            chart.set(at);
            (void)chart.move({step * way[0], step * way[1], step * way[2]});
        };
        for (std::size_t along = 1; along < (which == 1 ? 2u : 3u); ++along) {
            const double curvature = ways.at(along).curvature;
            go(ways.at(along).numbers, kStep);
            double off = 0.0;
            for (std::size_t n = 0; n < 3; ++n) off += (chart.values()[n] - at[n]) * ways[0].numbers[n];
            EXPECT_GT(curvature, 0.1);
            EXPECT_NEAR(off, -0.5 * curvature * kStep * kStep, 0.1 * curvature * kStep * kStep);
        }
        go(ways[0].numbers, -kStep);
        EXPECT_FALSE(chart.ways()[0].is_at_high);
    }
}

TEST(LimitChart, ClampsStepsWhereAnEllipseHasAFreeAxis) {
    constexpr float kFree = ConstraintRecord::kFree;
    const Constraint constraint =
        make_constraint(make(ConstraintModel::swing_twist_ellipse, {-1.5f, -kFree, -1.2f}, {0.4f, kFree, 0.3f}));
    IkLink link = link_of(constraint);
    link.local = link.rest_frame * glm::conjugate(link.frame);
    LimitChart chart;
    chart.begin(link);
    (void)chart.read(link, link.local);
    const glm::dquat moved = chart.step(link, {0.3, 0.9, -1.2});
    EXPECT_LT(violation(constraint, in_limits(link, moved)), 1e-6);
    EXPECT_GT(std::abs(1.0 - std::abs(glm::dot(moved, link.local))), 0.1);
}

TEST(LimitChart, HalvesAStepIntoASoftZone) {
    ConstraintView view = limits()[0];
    view.record.soft_zone = 0.5f;
    const Constraint constraint = make_constraint(view);
    IkLink link = link_of(constraint);
    link.local = link.rest_frame * glm::conjugate(link.frame);
    LimitChart chart;
    chart.begin(link);
    (void)chart.read(link, link.local);
    link.local = chart.step(link, {1.6, 0.0, 0.0});
    EXPECT_NEAR(chart.values()[0], 1.6, 1e-9);
    link.local = chart.step(link, {0.4, 0.0, 0.0});
    EXPECT_NEAR(chart.values()[0], 1.8, 1e-9);
    link.local = chart.step(link, {-0.4, 0.0, 0.0});
    EXPECT_NEAR(chart.values()[0], 1.4, 1e-9);
}

}  // namespace
}  // namespace bendy::limit_chart_test
