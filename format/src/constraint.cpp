#include <bendy/format/constraint.h>

#include <bendy/format/clip.h>
#include <bendy/format/read_record.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace bendy {
namespace {

using Triple = std::array<float, 3>;

constexpr std::uint64_t kFirstTranslation = 3;  // axes in faults: 0 to 2 for rotation, 3 to 5 for translation

/// Returns true if an angle on the circle is in the range: low <= angle + n turns <= high for an integer n.
/// `half_turns` is the angle as a multiple of pi as a float, so that ranges written as floats start where they should.
bool holds_angle(float low, double half_turns, float high) {
    constexpr double kHalfTurn = std::numbers::pi_v<float>;
    constexpr double kTurn = 2.0 * kHalfTurn;
    const double angle = half_turns * kHalfTurn;
    const double first = std::ceil((double{low} - angle) / kTurn);  // the smallest n that is not below the range
    return std::isinf(low) ? low < 0.0f && high > -ConstraintRecord::kFree : angle + first * kTurn <= double{high};
}

bool holds_angle_on_all_axes(const ConstraintRecord& constraint, double half_turns) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!holds_angle(constraint.rotation_min[axis], half_turns, constraint.rotation_max[axis])) return false;
    }
    return true;
}

/// Returns true if some finite number is in the range.
bool is_possible(float low, float high) {
    return low < ConstraintRecord::kFree && high > -ConstraintRecord::kFree;
}

/// Checks the range of an axis that the model uses; neither end is NaN.
bool is_possible(const ConstraintRecord& constraint, std::size_t axis) {
    const float low = constraint.rotation_min[axis];
    const float high = constraint.rotation_max[axis];
    switch (static_cast<ConstraintModel>(constraint.model)) {
        case ConstraintModel::swing_twist_ellipse:
        case ConstraintModel::swing_twist_pyramid:
            if (axis != 0) return low <= 0.0f && high >= 0.0f;  // a swing range contains rest
            return is_possible(low, high);
        case ConstraintModel::largest_angle:
            return high >= 0.0f;
        default:
            return is_possible(low, high);
    }
}

/// Checks for NaN on any axis, and for a minimum above its maximum on the first `axes`. `first` is the number of the X
/// axis in faults.
void check_pairs(const Triple& low, const Triple& high, std::size_t axes, std::uint64_t first, std::uint64_t offset,
                 Faults& faults) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (std::isnan(low[axis]) || std::isnan(high[axis])) {
            faults.add({ErrorCode::kNotFinite, offset, first + axis});
        } else if (axis < axes && low[axis] > high[axis]) {
            faults.add({ErrorCode::kLimitOrder, offset, first + axis});
        }
    }
}

void check_ranges(const ConstraintRecord& constraint, std::uint64_t offset, Faults& faults) {
    const auto model = static_cast<ConstraintModel>(constraint.model);
    const std::size_t axes = limited_axes(model);
    const std::size_t before = faults.count();
    check_pairs(constraint.rotation_min, constraint.rotation_max, model == ConstraintModel::largest_angle ? 0 : axes, 0,
                offset, faults);
    check_pairs(constraint.translation_min, constraint.translation_max, 3, kFirstTranslation, offset, faults);
    if (faults.count() != before) return;
    for (std::size_t axis = 0; axis < axes; ++axis) {
        if (!is_possible(constraint, axis)) faults.add({ErrorCode::kLimitRange, offset, axis});
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!is_possible(constraint.translation_min[axis], constraint.translation_max[axis]))
            faults.add({ErrorCode::kLimitRange, offset, kFirstTranslation + axis});
    }
}

}  // namespace

bool read_constraint(const ChunkTree& tree, std::uint32_t chunk, std::uint32_t joint, ConstraintView& constraint,
                     Faults& faults) {
    const Result<ConstraintRecord> record = read_record<ConstraintRecord>(tree, chunk);
    if (!record) {
        faults.add(record.error());
        return false;
    }
    constraint = {chunk, joint, *record};
    const std::uint64_t offset = tree[chunk].offset;
    return check_enum(record->model, kConstraintModels, offset, faults) &&
           check_enum(record->euler_order, kEulerOrders, offset, faults) &&
           check_enum(record->scope, kConstraintScopes, offset, faults) &&
           check_enum(record->flags, kConstraintFlags, offset, faults);
}

unsigned limited_axes(ConstraintModel model) {
    switch (model) {
        case ConstraintModel::hinge:
        case ConstraintModel::largest_angle:
            return 1;
        case ConstraintModel::swing_twist_ellipse:
        case ConstraintModel::swing_twist_pyramid:
        case ConstraintModel::euler_box:
            return 3;
        default:
            return 0;
    }
}

bool holds_rest(const ConstraintRecord& constraint) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!(constraint.translation_min[axis] <= 0.0f && constraint.translation_max[axis] >= 0.0f)) return false;
    }
    switch (static_cast<ConstraintModel>(constraint.model)) {
        case ConstraintModel::hinge:
            return holds_angle(constraint.rotation_min[0], 0.0, constraint.rotation_max[0]);
        case ConstraintModel::swing_twist_ellipse:
        case ConstraintModel::swing_twist_pyramid:
            return holds_angle(constraint.rotation_min[0], 0.0, constraint.rotation_max[0]) &&
                   constraint.rotation_min[1] <= 0.0f && constraint.rotation_max[1] >= 0.0f &&
                   constraint.rotation_min[2] <= 0.0f && constraint.rotation_max[2] >= 0.0f;
        case ConstraintModel::euler_box:  // no rotation has two forms: three times 0, and three times half a turn
            return holds_angle_on_all_axes(constraint, 0.0) || holds_angle_on_all_axes(constraint, 1.0);
        case ConstraintModel::largest_angle:
            return constraint.rotation_max[0] >= 0.0f;
        default:
            return true;
    }
}

void check_constraint(const ConstraintRecord& constraint, std::uint32_t joint, std::uint64_t offset, Faults& faults) {
    const std::size_t before = faults.count();
    if (!is_unit(constraint.frame, kUnitTolerance)) faults.add({ErrorCode::kRotationNotUnit, offset, joint});
    check_finite(std::array{constraint.soft_zone}, offset, faults);
    check_finite(constraint.preferred, offset, faults);
    if (std::isfinite(constraint.soft_zone) && constraint.soft_zone < 0.0f)
        faults.add({ErrorCode::kBelowZero, offset, offsetof(ConstraintRecord, soft_zone)});
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!(constraint.stiffness[axis] >= 0.0f && constraint.stiffness[axis] <= 1.0f)) {
            faults.add(
                {ErrorCode::kFractionRange, offset, offsetof(ConstraintRecord, stiffness) + axis * sizeof(float)});
        }
    }
    check_ranges(constraint, offset, faults);
    const bool is_sound = faults.count() == before;
    if (is_sound && !holds_rest(constraint) && (constraint.flags & kRestOutside) == 0)
        faults.add({ErrorCode::kRestOutside, offset, joint});
}

}  // namespace bendy
