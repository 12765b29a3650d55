#include "nearest_rotation.h"

#include "rotation.h"

#include <bendy/format/constraint.h>
#include <bendy/format/trig.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace bendy {
namespace {

/// Radians, or sines of half angles: tolerance for being inside, so that clamping an already clamped rotation changes
/// nothing.
constexpr double kInside = 1e-9;

/// The largest y^2 + z^2 of a clamped swing: after half a turn of swing the twist is undefined.
constexpr double kWidest = 1.0 - 1e-12;

double dot(const glm::dquat& a, const glm::dquat& b) {
    return a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
}

// --- angles on the circle

double wrapped(double angle) {
    constexpr double kTurn = 2.0 * trig::kPi;
    return angle - kTurn * std::nearbyint(angle / kTurn);
}

bool holds(const AngleRange& range, double angle) {
    return std::abs(wrapped(angle - range.middle)) <= range.half + kInside;
}

/// Returns the angle in the range that is nearest on the circle. Measured from the middle, so the result is continuous
/// at pi; the discontinuity is on the opposite side.
double nearest_angle(const AngleRange& range, double angle) {
    return range.middle + std::clamp(wrapped(angle - range.middle), -range.half, range.half);
}

/// Returns the rotation (cosine and sine of half the angle) in the range that is nearest to the given one; the same
/// rotation if it is inside.
glm::dvec2 nearest_turn(const AngleRange& range, const glm::dvec2& turn) {
    const double cosine = glm::dot(turn, range.middle_turn);  // of half the angle to the middle
    const double sine = turn.y * range.middle_turn.x - turn.x * range.middle_turn.y;
    if (std::abs(sine) <= range.sine_half + 0.5 * kInside) return turn;
    return (sine < 0.0) == (cosine < 0.0) ? range.high_turn : range.low_turn;
}

// --- swing and twist: R = swing * twist

/// A swing as the unit vector (w, y, z) of its quaternion, whose x is 0.
using Swing = glm::dvec3;

struct SwingTwist {
    Swing swing;   ///< w >= 0
    double twist;  ///< radians about X
};

glm::dquat join(const Swing& swing, double twist) {
    return glm::dquat(swing.x, 0.0, swing.y, swing.z) * about(0, twist);
}

/// After half a turn of swing the twist is undefined: it is taken as 0.
SwingTwist split(const glm::dquat& q) {
    const double length = std::sqrt(q.w * q.w + q.x * q.x);
    if (length < 1e-12) return {{0.0, q.y, q.z}, 0.0};
    const double c = q.w / length;
    const double s = q.x / length;
    // swing = q * conj(twist)
    return {{length, c * q.y - s * q.z, c * q.z + s * q.y}, wrapped(2.0 * trig::atan2(q.x, q.w))};
}

/// The half axes of the ellipse on the side of (y, z).
struct HalfAxes {
    double y, z;
};
HalfAxes half_axes(const LimitShape& shape, double y, double z) {
    return {std::signbit(y) ? shape.swing_low[0] : shape.swing_high[0],
            std::signbit(z) ? shape.swing_low[1] : shape.swing_high[1]};
}

/// A free axis turns the ellipse into a band: |y| <= a, any z.
bool is_free(double half_axis) {
    return half_axis > 1.0;
}

bool ellipse_holds(const LimitShape& shape, const Swing& swing) {
    const HalfAxes axes = half_axes(shape, swing.y, swing.z);
    if (std::abs(swing.y) > axes.y + kInside || std::abs(swing.z) > axes.z + kInside) return false;
    const double y = axes.y > kInside ? swing.y / axes.y : 0.0;
    const double z = axes.z > kInside ? swing.z / axes.z : 0.0;
    return y * y + z * z <= 1.0 + kInside;
}

/// Returns the point of a quarter of the ellipse with half axes (a, b) that is nearest to v on the sphere; w, y and z
/// of v are 0 or more.
Swing nearest_on_quarter(double a, double b, const Swing& v) {
    const auto point = [&](double y, double z) { return Swing(std::sqrt(std::max(0.0, 1.0 - y * y - z * z)), y, z); };
    if (is_free(a) && is_free(b)) return v;
    if (is_free(a) || is_free(b)) {
        // On the edge of the band, a circle, perpendicular to it from v.
        const double edge = is_free(a) ? b : a;
        const double along = is_free(a) ? v.y : v.z;
        const double length = std::sqrt(v.x * v.x + along * along);
        const double rest = length > 0.0 ? std::sqrt(std::max(0.0, kWidest - edge * edge)) * along / length : 0.0;
        return is_free(a) ? point(rest, edge) : point(edge, rest);
    }
    if (a < kInside) {
        const double length = std::sqrt(v.x * v.x + v.z * v.z);
        return point(0.0, length > 0.0 ? std::min(b, v.z / length) : 0.0);
    }
    if (b < kInside) {
        const double length = std::sqrt(v.x * v.x + v.y * v.y);
        return point(length > 0.0 ? std::min(a, v.y / length) : 0.0, 0.0);
    }
    const double across = std::sqrt(v.y * v.y + v.z * v.z);
    if (std::abs(a - b) < kInside && across > kInside) return point(a * v.y / across, a * v.z / across);
    // The derivative of the distance along the ellipse (a cos f, b sin f), with cos and sin from t = tan(f / 2).
    struct Place {
        double y, z, slope;
    };
    const auto place = [&](double t) {
        const double cosine = (1.0 - t * t) / (1.0 + t * t);
        const double sine = 2.0 * t / (1.0 + t * t);
        const double y = a * cosine;
        const double z = b * sine;
        const double w = std::sqrt(std::max(1e-30, 1.0 - y * y - z * z));
        return Place{y, z, b * cosine * v.z - a * sine * v.y + v.x * (a * a - b * b) * sine * cosine / w};
    };
    double low = 0.0;
    double high = 1.0;
    double at_low = place(low).slope;
    double at_high = place(high).slope;
    if (at_low <= 0.0 && at_high <= 0.0) return point(a, 0.0);
    if (at_low >= 0.0 && at_high >= 0.0) return point(0.0, b);
    for (int step = 0; step < 60 && high - low > 1e-14; ++step) {
        // Regula falsi, Illinois variant: the weight of the end that stays is halved.
        double t = (low * at_high - high * at_low) / (at_high - at_low);
        if (!(t > low && t < high)) t = 0.5 * (low + high);
        const Place here = place(t);
        if (here.slope > 0.0) {
            low = t;
            at_low = here.slope;
            at_high *= 0.5;
        } else if (here.slope < 0.0) {
            high = t;
            at_high = here.slope;
            at_low *= 0.5;
        } else {
            low = high = t;
        }
    }
    const Place end = place(0.5 * (low + high));
    return point(end.y, end.z);
}

/// A point of the whole ellipse. A quarter has t = tan(f / 2) in [0, 1]; four quarters make the circle: u modulo 4,
/// denser where the quarters meet, since that is where narrow ellipses have the highest curvature.
Swing ellipse_point(const LimitShape& shape, double u) {
    const double quarter = std::floor(u);
    const double part = u - quarter;
    const double t = part * part * (3.0 - 2.0 * part);
    double y = (1.0 - t * t) / (1.0 + t * t);
    double z = 2.0 * t / (1.0 + t * t);
    const int turns = static_cast<int>(quarter) & 3;
    if ((turns & 1) != 0) std::swap(y, z);
    if (turns == 1 || turns == 2) y = -y;
    if (turns == 2 || turns == 3) z = -z;
    const HalfAxes axes = half_axes(shape, y, z);
    const auto edge = [](double half_axis) { return std::sqrt(std::max(0.0, kWidest - half_axis * half_axis)); };
    if (is_free(axes.y) && is_free(axes.z)) {
        y *= kWidest;  // the whole quarter is legal; its boundary is that of the half sphere
        z *= kWidest;
    } else if (is_free(axes.y)) {
        y *= edge(axes.z);
        z = std::copysign(axes.z, z);
    } else if (is_free(axes.z)) {
        z *= edge(axes.y);
        y = std::copysign(axes.y, y);
    } else {
        y *= axes.y;
        z *= axes.z;
    }
    return {std::sqrt(std::max(0.0, 1.0 - y * y - z * z)), y, z};
}

/// Finds the maximum of f in [low, high], if it has one there, by golden-section search.
template <class F>
double find_top(double low, double high, const F& f) {
    constexpr double kGolden = 0.6180339887498949;
    double a = high - kGolden * (high - low);
    double b = low + kGolden * (high - low);
    double at_a = f(a);
    double at_b = f(b);
    while (high - low > 1e-9) {
        if (at_a > at_b) {
            high = b;
            b = a;
            at_b = at_a;
            a = high - kGolden * (high - low);
            at_a = f(a);
        } else {
            low = a;
            a = b;
            at_a = at_b;
            b = low + kGolden * (high - low);
            at_b = f(b);
        }
    }
    return 0.5 * (low + high);
}

/// Returns the point of the whole ellipse where closeness(swing) is largest. A first pass finds the peaks; each is then
/// searched on both sides of its highest sample, since there may be a discontinuity between them.
template <class Closeness>
Swing best_on_ellipse(const LimitShape& shape, const Closeness& closeness) {
    constexpr int kPoints = 64;
    constexpr double kStep = 4.0 / kPoints;
    const auto at = [&](double u) { return closeness(ellipse_point(shape, u)); };
    std::array<double, kPoints> round{};
    for (int i = 0; i < kPoints; ++i) round[static_cast<std::size_t>(i)] = at(kStep * i);
    const auto highest = std::max_element(round.begin(), round.end());
    double best = kStep * static_cast<double>(highest - round.begin());
    double best_closeness = *highest;
    const auto consider = [&](double u) {
        const double here = at(u);
        if (here <= best_closeness) return;
        best = u;
        best_closeness = here;
    };
    for (int i = 0; i < kPoints; ++i) {
        const double here = round[static_cast<std::size_t>(i)];
        const double before = round[static_cast<std::size_t>((i + kPoints - 1) % kPoints)];
        const double after = round[static_cast<std::size_t>((i + 1) % kPoints)];
        if (here < before || here <= after) continue;
        const double middle = kStep * (i + kPoints);
        consider(find_top(middle - kStep, middle, at));
        consider(find_top(middle, middle + kStep, at));
    }
    return ellipse_point(shape, best);
}

/// Returns the swing in the ellipse that is nearest to v, any unit vector (w, y, z).
Swing nearest_in_ellipse(const LimitShape& shape, const Swing& v) {
    if (v.x < 0.0) return best_on_ellipse(shape, [&](const Swing& s) { return glm::dot(s, v); });
    if (ellipse_holds(shape, v)) return v;
    // The nearest point is on the same side of both axes as v.
    const double side_y = std::signbit(v.y) ? -1.0 : 1.0;
    const double side_z = std::signbit(v.z) ? -1.0 : 1.0;
    const HalfAxes axes = half_axes(shape, v.y, v.z);
    const Swing s = nearest_on_quarter(axes.y, axes.z, {v.x, side_y * v.y, side_z * v.z});
    return {s.x, side_y * s.y, side_z * s.z};
}

/// Returns the pyramid's four planes, through the centre of the sphere: n . (w, y, z) <= 0 is legal.
std::array<Swing, 4> pyramid_planes(const LimitShape& shape) {
    const auto plane = [](double half_axis, double sign, bool about_y) {
        const double sine = std::min(half_axis, kWidest);
        const double cosine = std::sqrt(std::max(0.0, 1.0 - sine * sine));
        return about_y ? Swing(-sine, sign * cosine, 0.0) : Swing(-sine, 0.0, sign * cosine);
    };
    return {plane(shape.swing_high[0], 1.0, true), plane(shape.swing_low[0], -1.0, true),
            plane(shape.swing_high[1], 1.0, false), plane(shape.swing_low[1], -1.0, false)};
}

bool pyramid_holds(const std::array<Swing, 4>& planes, const Swing& swing) {
    return swing.x >= -kInside && std::all_of(planes.begin(), planes.end(),
                                              [&](const Swing& plane) { return glm::dot(plane, swing) <= kInside; });
}

/// Returns the swing in the pyramid that is nearest to v: v itself, or its projection on one of the planes, or a
/// corner.
Swing nearest_in_pyramid(const LimitShape& shape, const Swing& v) {
    const std::array<Swing, 4> planes = pyramid_planes(shape);
    if (pyramid_holds(planes, v)) return v;
    Swing best(1.0, 0.0, 0.0);
    const auto try_point = [&](const Swing& point) {
        const double length = std::sqrt(glm::dot(point, point));
        if (length < 1e-9) return;
        const Swing s = point / length;
        if (pyramid_holds(planes, s) && glm::dot(s, v) > glm::dot(best, v)) best = s;
    };
    for (const Swing& plane : planes) try_point(v - plane * glm::dot(plane, v));
    for (const std::size_t y : {0u, 1u}) {
        for (const std::size_t z : {2u, 3u}) {
            const Swing corner = glm::cross(planes[y], planes[z]);
            try_point(corner.x < 0.0 ? -corner : corner);
            if (std::abs(corner.x) < kInside) try_point(-corner);  // on the boundary, both ends are corners
        }
    }
    return best;
}

bool swing_holds(ConstraintModel model, const LimitShape& shape, const Swing& swing) {
    return model == ConstraintModel::swing_twist_ellipse ? ellipse_holds(shape, swing)
                                                         : pyramid_holds(pyramid_planes(shape), swing);
}

Swing nearest_swing(ConstraintModel model, const LimitShape& shape, const Swing& v) {
    return model == ConstraintModel::swing_twist_ellipse ? nearest_in_ellipse(shape, v) : nearest_in_pyramid(shape, v);
}

/// A candidate for the nearest rotation.
struct Found {
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
    double closeness = -1.0;  ///< cosine of half the angle to R

    void consider(const glm::dquat& other, const glm::dquat& R) {
        const double found = std::abs(dot(other, R));
        if (found <= closeness) return;
        rotation = other;
        closeness = found;
    }
};

/// With the twist at an end of its range, the best swing is the nearest on the sphere.
void consider_twist(ConstraintModel model, const LimitShape& shape, const glm::dquat& R, double twist, Found& best) {
    const glm::dquat v = R * about(0, -twist);
    const double length = std::sqrt(v.w * v.w + v.y * v.y + v.z * v.z);
    if (length < 1e-12) return;
    const Swing swing = Swing(v.w, v.y, v.z) / length;
    for (const Swing& side : {swing, -swing})  // R and -R are the same rotation, but two points of the sphere
        best.consider(join(nearest_swing(model, shape, side), twist), R);
}

/// With the twist free: cos^2 of half the angle that remains after the best twist.
struct LeftOver {
    Swing w, x;  ///< dot(w, swing), dot(x, swing): of conj(swing) * R
    explicit LeftOver(const glm::dquat& R) : w(R.w, R.y, R.z), x(R.x, -R.z, R.y) {}
    double operator()(const Swing& swing) const {
        const double a = glm::dot(w, swing);
        const double b = glm::dot(x, swing);
        return a * a + b * b;
    }
};

/// Considers the swing on the boundary of the legal range that, with the best twist, is nearest to R.
void consider_rim(ConstraintModel model, const LimitShape& shape, const glm::dquat& R, Found& best) {
    const LeftOver closeness(R);
    const auto consider = [&](const Swing& swing) {
        const double twist = 2.0 * trig::atan2(glm::dot(closeness.x, swing), glm::dot(closeness.w, swing));
        if (holds(shape.angles[0], twist)) best.consider(join(swing, nearest_angle(shape.angles[0], twist)), R);
    };
    if (model == ConstraintModel::swing_twist_ellipse) {
        const AngleRange& range = shape.angles[0];
        const Swing swing = best_on_ellipse(shape, [&](const Swing& s) {
            const double w = glm::dot(closeness.w, s);
            const double x = glm::dot(closeness.x, s);
            const double twist = 2.0 * trig::atan2(x, w);
            const double length = std::sqrt(w * w + x * x);
            return length * trig::sin_cos(0.5 * wrapped(twist - nearest_angle(range, twist))).cos;
        });
        consider(swing);
        return;
    }
    const std::array<Swing, 4> planes = pyramid_planes(shape);
    for (std::size_t edge = 0; edge < 4; ++edge) {
        // Along the edge, swing = u cos f + v sin f; closeness is largest at half the angle of (p, q).
        const Swing& plane = planes[edge];
        const Swing u = edge < 2 ? Swing(0.0, 0.0, 1.0) : Swing(0.0, 1.0, 0.0);
        const Swing v = glm::cross(plane, u);
        const double p = closeness(u) - closeness(v);
        const double q = closeness(u + v) - closeness(u) - closeness(v);
        const trig::SinCos f = trig::sin_cos(0.5 * trig::atan2(q, p));
        const Swing top = u * f.cos + v * f.sin;
        for (const Swing& swing : {top, -top}) {
            if (pyramid_holds(planes, swing)) consider(swing);
        }
        for (const std::size_t other : {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{3}}) {
            if ((edge < 2) == (other < 2)) continue;
            const Swing corner = glm::cross(plane, planes[other]);
            const double length = std::sqrt(glm::dot(corner, corner));
            if (length > 1e-9) consider(corner * ((corner.x < 0.0 ? -1.0 : 1.0) / length));
        }
    }
}

glm::dquat nearest_swing_twist(ConstraintModel model, const LimitShape& shape, const glm::dquat& R) {
    const SwingTwist parts = split(R);
    const AngleRange& twist = shape.angles[0];
    if (swing_holds(model, shape, parts.swing) && holds(twist, parts.twist)) return R;
    Found best;
    if (twist.half < trig::kPi) {
        consider_twist(model, shape, R, twist.middle - twist.half, best);
        consider_twist(model, shape, R, twist.middle + twist.half, best);
    }
    consider_rim(model, shape, R, best);
    return best.rotation;
}

// --- Euler angles: R = third * second * first

struct Order {
    std::array<int, 3> axes;  ///< in the order of rotation
    double sign;              ///< 1 if X, Y, Z can be rotated into them, otherwise -1
};
Order order_of(EulerOrder order) {
    constexpr auto kOrders = [] {
        std::array<Order, kEulerOrders> orders{};
        for (std::size_t n = 0; n < orders.size(); ++n) {
            const auto [first, second, third] = axes_of(static_cast<EulerOrder>(n));
            orders[n] = {{static_cast<int>(first), static_cast<int>(second), static_cast<int>(third)},
                         (first + 1) % 3 == second ? 1.0 : -1.0};
        }
        return orders;
    }();
    return kOrders[static_cast<std::size_t>(order)];
}

using Angles = std::array<double, 3>;  ///< first, second, third

glm::dquat turn(const Order& order, const Angles& angles) {
    return about(order.axes[2], angles[2]) * about(order.axes[1], angles[1]) * about(order.axes[0], angles[0]);
}

/// Bernardes and Viollet, "Quaternion to Euler angles conversion: a direct, general and computationally efficient
/// method", 2022.
Angles to_angles(const Order& order, const glm::dquat& q) {
    const auto [i, j, k] = order.axes;
    const double a = q.w - q[j];
    const double b = q[i] + order.sign * q[k];
    const double c = q[j] + q.w;
    const double d = order.sign * q[k] - q[i];
    const double half_sum = trig::atan2(b, a);
    const double half_difference = trig::atan2(d, c);
    return {wrapped(half_sum - half_difference),
            2.0 * trig::atan2(std::sqrt(c * c + d * d), std::sqrt(a * a + b * b)) - 0.5 * trig::kPi,
            wrapped(order.sign * (half_sum + half_difference))};
}

Angles other_form(const Angles& angles) {
    return {wrapped(angles[0] + trig::kPi), trig::kPi - angles[1], wrapped(angles[2] + trig::kPi)};
}

struct EulerBox {
    Order order;
    std::array<AngleRange, 3> ranges;  ///< in the order of rotation
};

EulerBox make_box(EulerOrder order, const LimitShape& shape) {
    EulerBox box{order_of(order), {}};
    for (std::size_t n = 0; n < 3; ++n) box.ranges[n] = shape.angles[static_cast<std::size_t>(box.order.axes[n])];
    return box;
}

bool box_holds(const EulerBox& box, const Angles& angles) {
    return holds(box.ranges[0], angles[0]) && holds(box.ranges[1], angles[1]) && holds(box.ranges[2], angles[2]);
}

Angles nearest_angles(const EulerBox& box, const Angles& angles) {
    return {nearest_angle(box.ranges[0], angles[0]), nearest_angle(box.ranges[1], angles[1]),
            nearest_angle(box.ranges[2], angles[2])};
}

/// With two angles fixed the best third has a closed form: optimises one after another until nothing improves.
glm::dquat climb_euler(const EulerBox& box, const glm::dquat& R, Angles angles) {
    constexpr int kRounds = 200;
    const auto [i, j, k] = box.order.axes;
    double last = -1.0;
    glm::dquat legal = turn(box.order, angles);
    for (int round = 0; round < kRounds; ++round) {
        const glm::dquat first = about(i, angles[0]);
        const glm::dquat third = glm::conjugate(about(k, angles[2]));
        const glm::dquat middle = third * R * glm::conjugate(first);
        angles[1] = nearest_angle(box.ranges[1], 2.0 * trig::atan2(middle[j], middle.w));
        const glm::dquat second = about(j, angles[1]);
        const glm::dquat right = glm::conjugate(second) * third * R;
        angles[0] = nearest_angle(box.ranges[0], 2.0 * trig::atan2(right[i], right.w));
        const glm::dquat left = R * glm::conjugate(second * about(i, angles[0]));
        angles[2] = nearest_angle(box.ranges[2], 2.0 * trig::atan2(left[k], left.w));
        legal = turn(box.order, angles);
        const double now = std::abs(dot(legal, R));
        if (now - last < 1e-15) break;
        last = now;
    }
    return legal;
}

glm::dquat nearest_in_box(const EulerBox& box, const glm::dquat& R) {
    const Angles angles = to_angles(box.order, R);
    const Angles other = other_form(angles);
    if (box_holds(box, angles) || box_holds(box, other)) return R;
    Found best;
    const auto climb_from = [&](const Angles& start) { best.consider(climb_euler(box, R, start), R); };
    climb_from(nearest_angles(box, angles));
    climb_from(nearest_angles(box, other));
    for (int corner = 0; corner < 8; ++corner) {
        Angles start{};
        for (std::size_t n = 0; n < 3; ++n)
            start[n] = box.ranges[n].middle + ((corner >> n & 1) != 0 ? box.ranges[n].half : -box.ranges[n].half);
        climb_from(start);
    }
    // If the second angle is a quarter turn the angles are not unique: R may still be legal.
    return angle_between(best.rotation, R) <= kInside ? R : best.rotation;
}

// --- the other models

glm::dquat nearest_on_hinge(const AngleRange& range, const glm::dquat& R) {
    const double angle = 2.0 * trig::atan2(R.x, R.w);
    const double legal = nearest_angle(range, angle);
    const bool is_hinge = R.y * R.y + R.z * R.z < kInside * kInside;
    if (is_hinge && std::abs(wrapped(angle - legal)) <= kInside) return R;
    return about(0, legal);
}

glm::dquat nearest_by_angle(double largest, const glm::dquat& R) {
    const glm::dvec3 v = to_vector(R);
    const double angle = std::sqrt(glm::dot(v, v));
    return angle <= largest + kInside ? R : from_vector(v * (largest / angle));
}

glm::dquat nearest_to_none(const glm::dquat& R) {
    const bool is_none = R.x * R.x + R.y * R.y + R.z * R.z < kInside * kInside;
    return is_none ? R : glm::dquat(1.0, 0.0, 0.0, 0.0);
}

}  // namespace

glm::dquat nearest_rotation(const ConstraintView& constraint, const LimitShape& shape, const glm::dquat& R) {
    const ConstraintModel model = constraint.model();
    switch (model) {
        case ConstraintModel::locked:
            return nearest_to_none(R);
        case ConstraintModel::hinge:
            return nearest_on_hinge(shape.angles[0], R);
        case ConstraintModel::swing_twist_ellipse:
        case ConstraintModel::swing_twist_pyramid:
            return nearest_swing_twist(model, shape, R);
        case ConstraintModel::euler_box:
            return nearest_in_box(make_box(constraint.euler_order(), shape), R);
        case ConstraintModel::largest_angle:
            return nearest_by_angle(shape.largest, R);
        default:
            return R;
    }
}

glm::dquat quick_legal_rotation(const ConstraintView& constraint, const LimitShape& shape, const glm::dquat& R) {
    const ConstraintModel model = constraint.model();
    if (model == ConstraintModel::swing_twist_ellipse || model == ConstraintModel::swing_twist_pyramid) {
        const double length = std::sqrt(R.w * R.w + R.x * R.x);
        const glm::dvec2 twist = length < 1e-12 ? glm::dvec2(1.0, 0.0) : glm::dvec2(R.w, R.x) / length;
        // swing = R * conj(twist); its x is 0
        const Swing swing(length, twist.x * R.y - twist.y * R.z, twist.x * R.z + twist.y * R.y);
        const glm::dvec2 legal_twist = nearest_turn(shape.angles[0], twist);
        const Swing legal_swing = nearest_swing(model, shape, swing);
        if (legal_twist == twist && legal_swing == swing) return R;
        return glm::dquat(legal_swing.x, 0.0, legal_swing.y, legal_swing.z) *
               glm::dquat(legal_twist.x, legal_twist.y, 0.0, 0.0);
    }
    if (model == ConstraintModel::hinge) {
        const double length = std::sqrt(R.w * R.w + R.x * R.x);
        const glm::dvec2 turn = length < 1e-12 ? glm::dvec2(1.0, 0.0) : glm::dvec2(R.w, R.x) / length;
        const glm::dvec2 legal = nearest_turn(shape.angles[0], turn);
        return {legal.x, legal.y, 0.0, 0.0};
    }
    if (model == ConstraintModel::euler_box) {
        const EulerBox box = make_box(constraint.euler_order(), shape);
        const Angles angles = to_angles(box.order, R);
        const Angles other = other_form(angles);
        if (box_holds(box, angles) || box_holds(box, other)) return R;
        const glm::dquat a = turn(box.order, nearest_angles(box, angles));
        const glm::dquat b = turn(box.order, nearest_angles(box, other));
        return std::abs(dot(a, R)) >= std::abs(dot(b, R)) ? a : b;
    }
    return nearest_rotation(constraint, shape, R);
}

double excess(const ConstraintView& constraint, const LimitShape& shape, const glm::dquat& R) {
    if (constraint.model() != ConstraintModel::swing_twist_ellipse)
        return angle_between(quick_legal_rotation(constraint, shape, R), R);
    const double length = std::sqrt(R.w * R.w + R.x * R.x);
    const glm::dvec2 twist = length < 1e-12 ? glm::dvec2(1.0, 0.0) : glm::dvec2(R.w, R.x) / length;
    const glm::dvec2 legal = nearest_turn(shape.angles[0], twist);
    // Sines of half angles: for the swing the distance to the ellipse to first order, which is zero on it.
    const double off_twist = legal == twist ? 0.0 : std::abs(twist.x * legal.y - twist.y * legal.x);
    const Swing swing(length, twist.x * R.y - twist.y * R.z, twist.x * R.z + twist.y * R.y);
    if (ellipse_holds(shape, swing)) return 2.0 * off_twist;
    const HalfAxes axes = half_axes(shape, swing.y, swing.z);
    const double least = 1e-6;  // an axis without width
    const double a = std::max(axes.y, least), b = std::max(axes.z, least);
    const double y = swing.y / a, z = swing.z / b;
    const double size = std::sqrt(y * y + z * z);
    const double slope = std::sqrt(y * y / (a * a) + z * z / (b * b)) / size;
    return 2.0 * (off_twist + (size - 1.0) / slope);
}

std::array<double, 3> euler_angles(const ConstraintView& constraint, const LimitShape& shape, const glm::dquat& R) {
    const EulerBox box = make_box(constraint.euler_order(), shape);
    const Angles angles = to_angles(box.order, R);
    const Angles other = other_form(angles);
    const auto outside = [&](const Angles& form) {
        const Angles inside = nearest_angles(box, form);
        return angle_between(turn(box.order, inside), R);
    };
    return outside(other) < outside(angles) ? other : angles;
}

}  // namespace bendy
