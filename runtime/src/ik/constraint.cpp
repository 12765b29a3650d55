#include <bendy/runtime/constraint.h>

#include "math/rotation.h"

#include <bendy/format/trig.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace bendy {
namespace {

constexpr double kTurn = 2.0 * trig::kPi;

AngleRange make_range(double low, double high, double soft_zone) {
    low = clamped(low, -1e3, 1e3, 0.0);
    high = clamped(high, -1e3, 1e3, 0.0);
    if (high < low) high = low;
    AngleRange range;
    range.half = 0.5 * (high - low);
    if (range.half >= trig::kPi) {
        range.half = trig::kPi;
    } else {
        range.middle = std::remainder(0.5 * (low + high), kTurn);
        range.half = std::max(0.0, range.half - soft_zone);
    }
    const auto turn = [](double angle) {
        const trig::SinCos parts = trig::sin_cos(0.5 * angle);
        return glm::dvec2(parts.cos, parts.sin);
    };
    range.middle_turn = turn(range.middle);
    range.low_turn = turn(range.middle - range.half);
    range.high_turn = turn(range.middle + range.half);
    range.sine_half = turn(range.half).y;
    return range;
}

/// Returns sin(limit / 2) for a swing limit on one side; infinity if it is free. Slightly below 1 at most: after half a
/// turn of swing the twist is undefined.
double half_axis(double limit, double soft_zone) {
    constexpr double kLargest = 1.0 - 1e-12;
    if (limit == std::numeric_limits<double>::infinity()) return limit;
    if (limit >= trig::kPi) return kLargest;
    return kLargest * trig::sin_cos(0.5 * std::max(0.0, clamped(limit, 0.0, trig::kPi, 0.0) - soft_zone)).sin;
}

LimitShape make_shape(const ConstraintRecord& record, double soft_zone) {
    LimitShape shape;
    for (std::size_t axis = 0; axis < 3; ++axis)
        shape.angles[axis] = make_range(record.rotation_min[axis], record.rotation_max[axis], soft_zone);
    for (std::size_t side = 0; side < 2; ++side) {
        shape.swing_low[side] = half_axis(-record.rotation_min[side + 1], soft_zone);
        shape.swing_high[side] = half_axis(record.rotation_max[side + 1], soft_zone);
    }
    shape.largest = std::max(0.0, clamped(record.rotation_max[0], 0.0, trig::kPi, 0.0) - soft_zone);
    return shape;
}

}  // namespace

Constraint make_constraint(const ConstraintView& view) {
    Constraint constraint{view};
    const ConstraintRecord& record = view.record;
    constraint.frame = unit_or_identity(record.frame);
    constraint.shape = make_shape(record, 0.0);
    constraint.has_soft_zone = record.soft_zone > 0.0f && record.soft_zone < ConstraintRecord::kFree;
    if (constraint.has_soft_zone) constraint.inner = make_shape(record, record.soft_zone);
    for (int axis = 0; axis < 3; ++axis) {
        const auto i = static_cast<std::size_t>(axis);
        constraint.stiffness[axis] = clamped(record.stiffness[i], 0.0, 1.0, 0.0);
        constraint.limits_translation = constraint.limits_translation ||
                                        record.translation_min[i] > -ConstraintRecord::kFree ||
                                        record.translation_max[i] < ConstraintRecord::kFree;
    }
    return constraint;
}

}  // namespace bendy
