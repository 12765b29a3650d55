#include "constraint_drawing.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace bendy::viewer {
namespace {

constexpr glm::vec3 kConeColour{0.95f, 0.55f, 0.08f};
constexpr glm::vec3 kTwistColour{0.75f, 0.1f, 0.55f};
constexpr std::array<glm::vec3, 3> kAxisColours{{{0.9f, 0.08f, 0.1f}, {0.15f, 0.75f, 0.1f}, {0.1f, 0.25f, 0.95f}}};

glm::dvec3 unit_axis(int axis) {
    glm::dvec3 v(0.0);
    v[axis] = 1.0;
    return v;
}

/// Returns the component of v perpendicular to an axis as a unit vector; the next axis if that component is too small.
glm::dvec3 across(const glm::dvec3& v, int axis) {
    glm::dvec3 rest = v;
    rest[axis] = 0.0;
    const double length = glm::length(rest);
    constexpr double kTooShort = 0.3;
    if (length > kTooShort * glm::length(v) && length > 0.0) return rest / length;
    return unit_axis((axis + 1) % 3);
}

LimitFan make_arc(const AngleRange& range, int axis, const glm::dvec3& zero, const glm::vec3& colour, float radius) {
    LimitFan fan;
    fan.colour = colour;
    fan.radius = radius;
    fan.axis = unit_axis(axis);
    constexpr double kStep = 0.08;  // radians
    const int steps = std::max(1, static_cast<int>(std::ceil(2.0 * range.half / kStep)));
    for (int k = 0; k <= steps; ++k) {
        const double angle = range.middle + range.half * (2.0 * k / steps - 1.0);
        fan.rim.emplace_back(glm::angleAxis(angle, fan.axis) * zero);
    }
    return fan;
}

constexpr double kWidest = 0.9995;  // sine of half the angle: the cone is nearly a sphere

/// Returns the largest legal swing towards an azimuth, as the sine of half its angle. See spec/constraints.md.
double widest_swing(const Constraint& constraint, double y, double z) {
    const LimitShape& shape = constraint.shape;
    const double a = y < 0.0 ? shape.swing_low[0] : shape.swing_high[0];
    const double b = z < 0.0 ? shape.swing_low[1] : shape.swing_high[1];
    constexpr double kNothing = 1e-6;
    if (constraint.model() == ConstraintModel::swing_twist_ellipse) {
        // A free axis makes a band, an axis with an empty range a line.
        const double along_y = std::isinf(a) ? 0.0 : std::abs(y) < kNothing ? 0.0 : y / std::max(a, 1e-9);
        const double along_z = std::isinf(b) ? 0.0 : std::abs(z) < kNothing ? 0.0 : z / std::max(b, 1e-9);
        const double slope = std::hypot(along_y, along_z);
        return slope * kWidest > 1.0 ? 1.0 / slope : kWidest;
    }
    // The planes are flat in (y / w, z / w): the tangents of the half angles.
    const auto reach = [&](double half_axis, double component) {
        if (half_axis >= kWidest || std::abs(component) < kNothing) return 1e6;
        return half_axis / std::sqrt(1.0 - half_axis * half_axis) / std::abs(component);
    };
    const double tangent = std::min(reach(a, y), reach(b, z));
    return std::min(kWidest, tangent / std::sqrt(1.0 + tangent * tangent));
}

LimitFan make_swing_cone(const Constraint& constraint) {
    LimitFan fan;
    fan.colour = kConeColour;
    fan.is_closed = true;
    constexpr int kSides = 72;
    for (int k = 0; k < kSides; ++k) {
        const double azimuth = glm::two_pi<double>() * k / kSides;
        const double y = std::cos(azimuth);
        const double z = std::sin(azimuth);
        const double sine = widest_swing(constraint, y, z);
        const glm::dquat swing(std::sqrt(1.0 - sine * sine), 0.0, sine * y, sine * z);
        fan.rim.emplace_back(swing * glm::dvec3(1.0, 0.0, 0.0));
    }
    return fan;
}

LimitFan make_round_cone(double half_angle, const glm::dvec3& middle) {
    LimitFan fan;
    fan.colour = kConeColour;
    fan.is_closed = true;
    const glm::dvec3 side = glm::normalize(glm::cross(middle, std::abs(middle.x) < 0.9 ? unit_axis(0) : unit_axis(1)));
    const glm::dvec3 other = glm::cross(middle, side);
    constexpr int kSides = 72;
    for (int k = 0; k < kSides; ++k) {
        const double azimuth = glm::two_pi<double>() * k / kSides;
        fan.rim.emplace_back(std::cos(half_angle) * middle +
                             std::sin(half_angle) * (std::cos(azimuth) * side + std::sin(azimuth) * other));
    }
    return fan;
}

bool is_all_round(const AngleRange& range) {
    return range.half >= glm::pi<double>();
}

}  // namespace

ConstraintDrawing make_constraint_drawing(const Constraint& constraint, const glm::vec3& bone) {
    ConstraintDrawing drawing;
    drawing.joint = constraint.joint;
    const double length = glm::length(glm::dvec3(bone));
    const glm::dvec3 towards = length > 0.0 ? glm::dvec3(bone) / length : glm::dvec3(1.0, 0.0, 0.0);
    const LimitShape& shape = constraint.shape;
    switch (constraint.model()) {
        case ConstraintModel::locked:
            drawing.is_locked = true;
            drawing.pointer = glm::vec3(towards);
            break;
        case ConstraintModel::hinge: {
            const glm::dvec3 zero = across(towards, 0);
            drawing.pointer = glm::vec3(zero);
            drawing.fans.push_back(make_arc(shape.angles[0], 0, zero, kAxisColours[0], 1.0f));
            break;
        }
        case ConstraintModel::swing_twist_ellipse:
        case ConstraintModel::swing_twist_pyramid:
            drawing.fans.push_back(make_swing_cone(constraint));
            if (!is_all_round(shape.angles[0]))
                drawing.fans.push_back(make_arc(shape.angles[0], 0, unit_axis(1), kTwistColour, 0.35f));
            break;
        case ConstraintModel::euler_box:
            drawing.pointer = glm::vec3(towards);
            for (int axis = 0; axis < 3; ++axis) {
                const auto i = static_cast<std::size_t>(axis);
                if (is_all_round(shape.angles[i]) || shape.angles[i].half == 0.0) continue;
                drawing.fans.push_back(make_arc(shape.angles[i], axis, across(towards, axis), kAxisColours[i], 0.8f));
            }
            break;
        case ConstraintModel::largest_angle:
            drawing.pointer = glm::vec3(towards);
            drawing.fans.push_back(make_round_cone(shape.largest, towards));
            break;
        default:
            break;
    }
    return drawing;
}

}  // namespace bendy::viewer
