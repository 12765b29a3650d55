#pragma once

#include <bendy/format/trig.h>

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>

// Rotations in double precision, for the constraints and the IK solvers.
namespace bendy {

/// Returns a value of a file, clamped to [low, high]; `otherwise` if it is NaN.
inline double clamped(double value, double low, double high, double otherwise) {
    return std::isnan(value) ? otherwise : std::clamp(value, low, high);
}

/// Returns a rotation of a file (x y z w) with unit length; the identity if that would be meaningless.
inline glm::dquat unit_or_identity(const std::array<float, 4>& rotation) {
    const glm::dquat q(rotation[3], rotation[0], rotation[1], rotation[2]);
    const double length = glm::length(q);
    return length > 1e-3 && length < 1e3 ? q / length : glm::dquat(1.0, 0.0, 0.0, 0.0);
}

/// Returns the same rotation with w >= 0.
inline glm::dquat upper_half(const glm::dquat& q) {
    return q.w < 0.0 ? -q : q;
}

/// Returns the rotation by `angle` radians about a coordinate axis, 0 to 2.
inline glm::dquat about(int axis, double angle) {
    const trig::SinCos half = trig::sin_cos(0.5 * angle);
    glm::dquat q(half.cos, 0.0, 0.0, 0.0);
    q[axis] = half.sin;  // glm: x y z w
    return q;
}

/// Returns the rotation by the vector's length, in radians, about its direction.
inline glm::dquat from_vector(const glm::dvec3& v) {
    const double angle = std::sqrt(glm::dot(v, v));
    if (angle < 1e-12) return glm::normalize(glm::dquat(1.0, 0.5 * v));
    const trig::SinCos half = trig::sin_cos(0.5 * angle);
    return {half.cos, v * (half.sin / angle)};
}

/// Returns the rotation vector of q, with length 0 to pi.
inline glm::dvec3 to_vector(const glm::dquat& q) {
    const glm::dquat u = upper_half(q);
    const glm::dvec3 v(u.x, u.y, u.z);
    const double sine = std::sqrt(glm::dot(v, v));
    if (sine < 1e-12) return 2.0 * v;
    return v * (2.0 * trig::atan2(sine, u.w) / sine);
}

/// Returns the rotation at a fraction of the way from a to b, along the shorter arc.
inline glm::dquat between(const glm::dquat& a, const glm::dquat& b, double share) {
    return glm::normalize(a * from_vector(share * to_vector(glm::conjugate(a) * b)));
}

/// Returns the angle between two rotations, 0 to pi. Accurate for small angles too.
inline double angle_between(const glm::dquat& a, const glm::dquat& b) {
    const glm::dquat d = glm::conjugate(a) * b;
    return 2.0 * trig::atan2(std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z), std::abs(d.w));
}

/// Returns the smallest rotation from the direction of `from` to that of `to`; identity if one of them has no length.
inline glm::dquat between(const glm::dvec3& from, const glm::dvec3& to) {
    const double lengths = std::sqrt(glm::dot(from, from) * glm::dot(to, to));
    if (!(lengths > 1e-200)) return {1.0, 0.0, 0.0, 0.0};
    const double w = lengths + glm::dot(from, to);
    if (w > 1e-9 * lengths) return glm::normalize(glm::dquat(w, glm::cross(from, to)));
    // Opposite directions: half a turn about any perpendicular axis.
    const glm::dvec3 other = std::abs(from.x) < std::abs(from.z) ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1);
    return {0.0, glm::normalize(glm::cross(from, other))};
}

}  // namespace bendy
