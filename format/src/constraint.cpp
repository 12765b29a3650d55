#include <bendy/format/constraint.h>

#include <bendy/format/cycle.h>
#include <bendy/format/read_record.h>

#include <numbers>

namespace bendy {
namespace {

constexpr float kTurn = 2.0f * std::numbers::pi_v<float>;

bool holds(float low, float value, float high) {
    return low <= value && value <= high;  // false for NaN
}

bool is_possible(const LimitRecord& limit, std::size_t axis) {
    const float low = limit.rotation_min[axis];
    const float high = limit.rotation_max[axis];
    switch (static_cast<LimitModel>(limit.model)) {
        case LimitModel::swing_twist_ellipse:
        case LimitModel::swing_twist_pyramid:
            if (axis != 0) return low <= 0.0f && high >= 0.0f;  // a swing range opens on both sides of rest
            [[fallthrough]];
        case LimitModel::hinge:
        case LimitModel::euler_box: return low < LimitRecord::kFree && high > -LimitRecord::kFree;
        case LimitModel::largest_angle: return high >= 0.0f;
        default: return true;
    }
}

void check_pairs(const std::array<float, 3>& low, const std::array<float, 3>& high, std::size_t axes,
                 std::uint64_t offset, Faults& faults) {
    for (std::size_t axis = 0; axis < axes; ++axis) {
        if (std::isnan(low[axis]) || std::isnan(high[axis])) {
            faults.add({ErrorCode::kNotFinite, offset, axis});
        } else if (low[axis] > high[axis]) {
            faults.add({ErrorCode::kLimitOrder, offset, axis});
        }
    }
}

}  // namespace

bool read_limit(const ChunkTree& tree, std::uint32_t chunk, std::uint32_t joint, LimitView& limit, Faults& faults) {
    const Result<LimitRecord> record = read_record<LimitRecord>(tree, chunk);
    if (!record) {
        faults.add(record.error());
        return false;
    }
    limit = {chunk, joint, *record};
    const std::uint64_t offset = tree[chunk].offset;
    return check_enum(record->model, kLimitModels, offset, faults) &&
           check_enum(record->euler_order, kEulerOrders, offset, faults) &&
           check_enum(record->scope, kLimitScopes, offset, faults) &&
           check_enum(record->flags, kLimitFlags, offset, faults);
}

unsigned limited_axes(LimitModel model) {
    switch (model) {
        case LimitModel::hinge:
        case LimitModel::largest_angle: return 1;
        case LimitModel::swing_twist_ellipse:
        case LimitModel::swing_twist_pyramid:
        case LimitModel::euler_box: return 3;
        default: return 0;
    }
}

bool holds_rest(const LimitRecord& limit) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!holds(limit.translation_min[axis], 0.0f, limit.translation_max[axis])) return false;
    }
    const auto model = static_cast<LimitModel>(limit.model);
    if (model == LimitModel::largest_angle) return limit.rotation_max[0] >= 0.0f;
    for (std::size_t axis = 0; axis < limited_axes(model); ++axis) {
        // A range that holds a whole turn away from 0 holds 0 as well: angles are angles on the circle.
        const float low = limit.rotation_min[axis];
        const float high = limit.rotation_max[axis];
        if (!holds(low, 0.0f, high) && !holds(low, kTurn, high) && !holds(low, -kTurn, high)) return false;
    }
    return true;
}

void check_limit(const LimitRecord& limit, std::uint32_t joint, std::uint64_t offset, Faults& faults) {
    const auto model = static_cast<LimitModel>(limit.model);
    const std::size_t before = faults.count();
    if (!is_unit(limit.frame, kUnitTolerance)) faults.add({ErrorCode::kRotationNotUnit, offset, joint});
    check_finite(std::array{limit.soft_zone}, offset, faults);
    check_finite(limit.preferred, offset, faults);
    if (limit.soft_zone < 0.0f) faults.add({ErrorCode::kLimitRange, offset, 0});
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!holds(0.0f, limit.stiffness[axis], 1.0f)) faults.add({ErrorCode::kFractionRange, offset, axis});
    }
    check_pairs(limit.rotation_min, limit.rotation_max, model == LimitModel::largest_angle ? 0 : limited_axes(model),
                offset, faults);
    check_pairs(limit.translation_min, limit.translation_max, 3, offset, faults);
    for (std::size_t axis = 0; axis < limited_axes(model); ++axis) {
        if (std::isnan(limit.rotation_max[axis])) {
            if (model == LimitModel::largest_angle) faults.add({ErrorCode::kNotFinite, offset, axis});
        } else if (!is_possible(limit, axis)) {
            faults.add({ErrorCode::kLimitRange, offset, axis});
        }
    }
    const bool is_sound = faults.count() == before;
    if (is_sound && !holds_rest(limit) && (limit.flags & kRestOutside) == 0)
        faults.add({ErrorCode::kRestOutside, offset, joint});
}

}  // namespace bendy
