#include "pose/limit_chart.h"

#include "ik_problem.h"
#include "math/nearest_rotation.h"
#include "math/rotation.h"

#include <bendy/format/trig.h>
#include <bendy/runtime/constrain.h>

#include <algorithm>
#include <cmath>

namespace bendy {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// Returns the tangent of an angle from its sine; both of half a limit.
double tangent_of_half(double sine) {
    return sine / std::sqrt(std::max(1e-24, 1.0 - sine * sine));
}

glm::dvec3 unit_axis(int axis) {
    glm::dvec3 v(0.0);
    v[axis] = 1.0;
    return v;
}

double inverse_or_zero(double number) {
    return number != 0.0 ? 1.0 / number : 0.0;
}

/// Returns true for an ellipse one of whose axes nothing limits: it is none in these coordinates.
bool is_band(const Constraint& constraint) {
    const LimitShape& shape = constraint.shape;
    return constraint.model() == ConstraintModel::swing_twist_ellipse &&
           std::max({shape.swing_low[0], shape.swing_low[1], shape.swing_high[0], shape.swing_high[1]}) > 1.0;
}

}  // namespace

void LimitChart::begin(const IkLink& link) {
    rest_frame_ = glm::dquat(1.0, 0.0, 0.0, 0.0);
    frame_ = link.frame;
    kind_ = Kind::free;
    size_ = link.is_fixed ? 0 : 3;
    clamps_ = false;
    low_.fill(-kUnlimited);
    high_.fill(kUnlimited);
    if (link.constraint == nullptr || link.is_fixed) return;
    const Constraint& constraint = *link.constraint;
    clamps_ = constraint.has_soft_zone;
    const LimitShape& shape = constraint.shape;
    if (constraint.model() != ConstraintModel::free && !is_band(constraint)) rest_frame_ = link.rest_frame;
    const auto put_angle = [&](std::size_t to, const AngleRange& range) {
        if (range.half >= trig::kPi) return;
        low_[to] = range.middle - range.half;
        high_[to] = range.middle + range.half;
    };
    switch (constraint.model()) {
        case ConstraintModel::hinge:
            kind_ = Kind::hinge;
            size_ = 1;
            put_angle(0, shape.angles[0]);
            return;
        case ConstraintModel::swing_twist_ellipse:
        case ConstraintModel::swing_twist_pyramid:
            if (is_band(constraint)) {
                clamps_ = true;
                return;
            }
            kind_ = constraint.model() == ConstraintModel::swing_twist_ellipse ? Kind::ellipse : Kind::pyramid;
            for (std::size_t i = 0; i < 2; ++i) {
                low_[i] = shape.swing_low[i] > 1.0 ? -kUnlimited : -tangent_of_half(shape.swing_low[i]);
                high_[i] = shape.swing_high[i] > 1.0 ? kUnlimited : tangent_of_half(shape.swing_high[i]);
                inverse_low_[i] = inverse_or_zero(low_[i]);
                inverse_high_[i] = inverse_or_zero(high_[i]);
            }
            put_angle(2, shape.angles[0]);
            return;
        case ConstraintModel::euler_box: {
            kind_ = Kind::euler;
            const auto axes = axes_of(constraint.euler_order());
            for (std::size_t i = 0; i < 3; ++i) {
                order_[i] = static_cast<int>(axes[2 - i]);
                put_angle(i, shape.angles[axes[2 - i]]);
            }
            return;
        }
        case ConstraintModel::largest_angle:
            return put_ball(shape.largest, link.rest_frame);
        default:
            return;
    }
}

void LimitChart::begin_within(const IkLink& link, double largest, const glm::dquat& from) {
    begin(link);
    clamps_ = link.constraint != nullptr;
    if (size_ > 0) put_ball(largest, from * link.frame);
}

void LimitChart::put_ball(double largest, const glm::dquat& middle) {
    rest_frame_ = middle;
    if (largest >= trig::kPi) return;
    kind_ = Kind::ball;
    const double most = tangent_of_half(trig::sin_cos(0.5 * largest).sin);
    low_.fill(-most);
    high_.fill(most);
}

glm::dquat LimitChart::read(const IkLink& link, const glm::dquat& local) {
    if (size_ == 0 || kind_ == Kind::free) {
        const glm::dquat inside = clamps_ ? legal_local(link, local) : local;
        rebase(inside);
        return inside;
    }
    const glm::dquat R = upper_half(glm::conjugate(rest_frame_) * local * frame_);
    const auto put_angle = [&](std::size_t to, double angle) {
        const bool is_limited = high_[to] < kUnlimited;
        const double middle = is_limited ? 0.5 * (low_[to] + high_[to]) : 0.0;
        values_[to] = middle + std::remainder(angle - middle, 2.0 * trig::kPi);
    };
    if (kind_ == Kind::euler) {
        const auto angles = euler_angles(*link.constraint, link.constraint->shape, R);
        for (std::size_t i = 0; i < 3; ++i) put_angle(i, angles[2 - i]);
    } else if (kind_ == Kind::ball) {
        const double w = std::max(R.w, 1e-9);
        values_ = {R.x / w, R.y / w, R.z / w};
    } else {
        const double length = std::sqrt(R.w * R.w + R.x * R.x);
        const double c = length < 1e-12 ? 1.0 : R.w / length, s = length < 1e-12 ? 0.0 : R.x / length;
        put_angle(size_ - 1, 2.0 * trig::atan2(s, c));
        if (kind_ != Kind::hinge) {
            const double w = std::max(length, 1e-9);
            values_[0] = (c * R.y - s * R.z) / w;
            values_[1] = (c * R.z + s * R.y) / w;
        }
    }
    return move({});
}

std::array<glm::dvec3, 3> LimitChart::axes() const {
    std::array<glm::dvec3, 3> found{};
    switch (kind_) {
        case Kind::free:
            return {unit_axis(0), unit_axis(1), unit_axis(2)};
        case Kind::hinge:
            found[0] = unit_axis(0);
            return found;
        case Kind::euler: {
            glm::dquat outer(1.0, 0.0, 0.0, 0.0);
            for (std::size_t i = 0; i < 3; ++i) {
                found[i] = outer * unit_axis(order_[i]);
                outer = outer * about(order_[i], values_[i]);
            }
            return found;
        }
        case Kind::ball: {
            const glm::dvec3 v(values_[0], values_[1], values_[2]);
            const double part = 2.0 / (1.0 + glm::dot(v, v));
            for (int i = 0; i < 3; ++i)
                found.at(static_cast<std::size_t>(i)) = part * (unit_axis(i) + glm::cross(v, unit_axis(i)));
            return found;
        }
        default: {
            const double y = values_[0], z = values_[1];
            const double size = 1.0 + y * y + z * z;
            const double part = 2.0 / size;
            found[0] = glm::dvec3(-z, 1.0, 0.0) * part;
            found[1] = glm::dvec3(y, 0.0, 1.0) * part;
            found[2] = glm::dvec3(part - 1.0, z * part, -y * part);
            return found;
        }
    }
}

glm::dquat LimitChart::move(const Numbers& step) {
    for (std::size_t i = 0; i < size_; ++i) values_[i] = std::clamp(values_[i] + step[i], low_[i], high_[i]);
    if (kind_ == Kind::ellipse) {
        const double y = share(0), z = share(1);
        const double size = y * y + z * z;
        if (size > 1.0) {
            const double part = 1.0 / std::sqrt(size);
            values_[0] *= part;
            values_[1] *= part;
        }
    }
    if (kind_ == Kind::ball) {
        const double size = glm::length(glm::dvec3(values_[0], values_[1], values_[2]));
        if (size > high_[0]) {
            for (double& value : values_) value *= high_[0] / size;
        }
    }
    if (kind_ == Kind::free) return glm::normalize(from_vector({values_[0], values_[1], values_[2]}) * local_);
    return rest_frame_ * rotation() * glm::conjugate(frame_);
}

glm::dquat LimitChart::step(const IkLink& link, const Numbers& by) {
    glm::dquat to = move(by);
    if (clamps_) (void)read(link, to = softly_legal_local(link, to));
    return to;
}

glm::dquat LimitChart::rotation() const {
    if (kind_ == Kind::ball) return glm::normalize(glm::dquat(1.0, values_[0], values_[1], values_[2]));
    if (kind_ == Kind::hinge) return about(0, values_[0]);
    if (kind_ == Kind::euler)
        return about(order_[0], values_[0]) * about(order_[1], values_[1]) * about(order_[2], values_[2]);
    const double y = values_[0], z = values_[1], part = 1.0 / std::sqrt(1.0 + y * y + z * z);
    const trig::SinCos twist = trig::sin_cos(0.5 * values_[2]);
    const double c = twist.cos * part, s = twist.sin * part;
    return {c, s, y * c + z * s, z * c - y * s};
}

std::array<LimitChart::Way, 3> LimitChart::ways() const {
    constexpr double kAt = 1e-12, kOn = 1e-9;
    std::array<Way, 3> ways{};
    for (std::size_t i = 0; i < size_; ++i) {
        ways[i].numbers[i] = 1.0;
        ways[i].is_at_low = values_[i] <= low_[i] + kAt;
        ways[i].is_at_high = values_[i] >= high_[i] - kAt;
    }
    const auto follow = [&](const glm::dvec3& normal, const glm::dvec3& along, double curvature) {
        ways[0] = {{normal.x, normal.y, normal.z}, false, true, 0.0};
        ways[1] = {{along.x, along.y, along.z}, false, false, curvature};
    };
    if (kind_ == Kind::ellipse) {
        const auto limit = [&](std::size_t i) { return (values_[i] < 0.0 ? low_ : high_)[i]; };
        const double y = share(0), z = share(1);
        if (limit(0) == 0.0 || limit(1) == 0.0 || y * y + z * z < 1.0 - kOn) return ways;
        const double a = 1.0 / limit(0), b = 1.0 / limit(1);
        const double part = 1.0 / std::sqrt(y * y * a * a + z * z * b * b), flat = a * b * part;
        const glm::dvec3 normal(y * a * part, z * b * part, 0.0);
        follow(normal, {-normal.y, normal.x, 0.0}, flat * flat * part);
    } else if (kind_ == Kind::ball) {
        const glm::dvec3 v(values_[0], values_[1], values_[2]);
        const double size = glm::length(v);
        if (size < high_[0] * (1.0 - kOn) || !(size > 0.0)) return ways;
        const glm::dvec3 normal = v / size;
        const glm::dvec3 side = unit_axis(std::abs(normal.x) < 0.7 ? 0 : 1);
        const glm::dvec3 along = glm::normalize(glm::cross(normal, side)), across = glm::cross(normal, along);
        follow(normal, along, 1.0 / size);
        ways[2] = {{across.x, across.y, across.z}, false, false, 1.0 / size};
    }
    return ways;
}

glm::dquat between_legal(const Constraint& constraint, const glm::dquat& a, const glm::dquat& b, double share) {
    const auto legal = [&](const glm::dquat& R) { return quick_legal_rotation(constraint, constraint.shape, R); };
    const ConstraintModel model = constraint.model();
    if (model == ConstraintModel::free || model == ConstraintModel::locked || is_band(constraint))
        return legal(between(a, b, share));
    IkLink link{};
    link.constraint = &constraint;
    link.frame = link.rest_frame = glm::dquat(1.0, 0.0, 0.0, 0.0);
    LimitChart chart;
    chart.begin(link);
    (void)chart.read(link, legal(b));
    LimitChart::Numbers step = chart.values();
    (void)chart.read(link, legal(a));
    for (std::size_t i = 0; i < chart.size(); ++i) {
        step[i] -= chart.values()[i];
        if (chart.goes_around(i)) step[i] = std::remainder(step[i], 2.0 * trig::kPi);
        step[i] *= share;
    }
    return chart.move(step);
}

}  // namespace bendy
