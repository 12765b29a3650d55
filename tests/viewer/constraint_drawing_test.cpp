#include "constraint_drawing.h"

#include <gtest/gtest.h>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cmath>
#include <limits>

namespace bendy::viewer::constraint_drawing_test {
namespace {

constexpr float kFree = std::numeric_limits<float>::infinity();

Constraint constraint_of(ConstraintModel model, std::array<float, 3> low, std::array<float, 3> high) {
    ConstraintView view;
    view.record.model = static_cast<std::uint8_t>(model);
    view.record.rotation_min = low;
    view.record.rotation_max = high;
    return make_constraint(view);
}

/// The shortest turn from X to a direction, times `factor`.
glm::dquat swing_to(const glm::vec3& direction, double factor) {
    const glm::dvec3 d(direction);
    const glm::dvec3 axis = glm::cross(glm::dvec3(1.0, 0.0, 0.0), d);
    const double angle = std::atan2(glm::length(axis), d.x);
    return glm::angleAxis(factor * angle, glm::normalize(axis));
}

// The runtime's own clamping is the judge: just inside the drawn edge is legal, just outside is not.
void expect_edge_of_limits(const Constraint& constraint) {
    const ConstraintDrawing drawing = make_constraint_drawing(constraint, {});
    ASSERT_FALSE(drawing.fans.empty());
    ASSERT_TRUE(drawing.fans[0].is_closed);
    for (const glm::vec3& edge : drawing.fans[0].rim) {
        EXPECT_NEAR(glm::length(edge), 1.0f, 1e-5f);
        EXPECT_LE(violation(constraint, swing_to(edge, 0.999)), 1e-9);
        EXPECT_GT(violation(constraint, swing_to(edge, 1.01)), 1e-6);
    }
}

TEST(ConstraintDrawing, SwingEllipseIsTheEdgeOfWhatIsLegal) {
    expect_edge_of_limits(
        constraint_of(ConstraintModel::swing_twist_ellipse, {-0.5f, -0.4f, -1.2f}, {0.5f, 0.9f, 0.3f}));
}

TEST(ConstraintDrawing, SwingPyramidIsTheEdgeOfWhatIsLegal) {
    expect_edge_of_limits(
        constraint_of(ConstraintModel::swing_twist_pyramid, {-0.5f, -0.4f, -1.2f}, {0.5f, 0.9f, 0.3f}));
}

TEST(ConstraintDrawing, LargestAngleIsARoundCone) {
    const Constraint constraint =
        constraint_of(ConstraintModel::largest_angle, {0, -kFree, -kFree}, {0.7f, kFree, kFree});
    const ConstraintDrawing drawing = make_constraint_drawing(constraint, {0.0f, 2.0f, 0.0f});
    ASSERT_EQ(drawing.fans.size(), 1u);
    for (const glm::vec3& edge : drawing.fans[0].rim) EXPECT_NEAR(edge.y, std::cos(0.7f), 1e-5f);
}

TEST(ConstraintDrawing, HingeArcGoesFromEndToEndAcrossItsAxis) {
    const Constraint constraint = constraint_of(ConstraintModel::hinge, {-0.2f, 0, 0}, {1.4f, 0, 0});
    const ConstraintDrawing drawing = make_constraint_drawing(constraint, {0.1f, 0.0f, 0.5f});
    ASSERT_EQ(drawing.fans.size(), 1u);
    const LimitFan& arc = drawing.fans[0];
    EXPECT_FALSE(arc.is_closed);
    // Z turned about X: by -0.2 towards +Y, by 1.4 towards -Y.
    EXPECT_LT(glm::length(arc.rim.front() - glm::vec3(0, std::sin(0.2f), std::cos(0.2f))), 1e-5f);
    EXPECT_LT(glm::length(arc.rim.back() - glm::vec3(0, -std::sin(1.4f), std::cos(1.4f))), 1e-5f);
    EXPECT_EQ(drawing.pointer, glm::vec3(0, 0, 1));
}

TEST(ConstraintDrawing, EulerBoxHasAnArcForEachAxisThatIsLimited) {
    const Constraint constraint = constraint_of(ConstraintModel::euler_box, {-0.2f, -kFree, 0.0f}, {0.4f, kFree, 0.0f});
    const ConstraintDrawing drawing = make_constraint_drawing(constraint, {0.0f, 1.0f, 0.0f});
    ASSERT_EQ(drawing.fans.size(), 1u);  // Y is free, Z cannot turn
    EXPECT_EQ(drawing.fans[0].axis, glm::dvec3(1, 0, 0));
}

TEST(ConstraintDrawing, LockedAndFree) {
    EXPECT_TRUE(make_constraint_drawing(constraint_of(ConstraintModel::locked, {}, {}), {}).is_locked);
    EXPECT_TRUE(make_constraint_drawing(constraint_of(ConstraintModel::free, {}, {}), {}).fans.empty());
}

TEST(ConstraintDrawing, FreeSwingIsAllButABall) {
    const Constraint constraint =
        constraint_of(ConstraintModel::swing_twist_ellipse, {-0.5f, -kFree, -kFree}, {0.5f, kFree, kFree});
    const ConstraintDrawing drawing = make_constraint_drawing(constraint, {});
    for (const glm::vec3& edge : drawing.fans[0].rim) EXPECT_LT(edge.x, -0.99f);
}

}  // namespace
}  // namespace bendy::viewer::constraint_drawing_test
