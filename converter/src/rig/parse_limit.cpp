#include "parse_limit.h"

#include "failure.h"
#include "fields.h"
#include "names.h"

#include <bendy/format/constraint.h>
#include <bendy/format/diagnostics.h>

#include <bitset>
#include <optional>

namespace bendy::converter {
namespace {

/// Fails where a member is there that means nothing for the model.
void refuse(Fields& fields, std::string_view key, LimitModel model) {
    if (fields.find(key) == nullptr) return;
    fail(fields.place_of(key),
         "it means nothing for model " + std::string(kModelNames[static_cast<std::size_t>(model)]));
}

void read_rotation_limits(Fields& fields, LimitModel model, LimitRecord& limit) {
    if (model == LimitModel::largest_angle) {
        if (const OrderedJson* angle = fields.find("angle"); angle != nullptr && !angle->is_null()) {
            fields.read_angle("angle", limit.rotation_max[0]);
            if (limit.rotation_max[0] < 0.0f) fail(fields.place_of("angle"), "it is less than 0");
        }
    } else {
        refuse(fields, "angle", model);
    }
    const std::size_t ranges = model == LimitModel::largest_angle ? 0 : limited_axes(model);
    const bool is_swing = model == LimitModel::swing_twist_ellipse || model == LimitModel::swing_twist_pyramid;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (axis >= ranges) {
            refuse(fields, kAxisNames[axis], model);
            continue;
        }
        float& low = limit.rotation_min[axis];
        float& high = limit.rotation_max[axis];
        fields.read_angle_range(kAxisNames[axis], low, high);
        if (is_swing && axis != 0 && !(low <= 0.0f && high >= 0.0f))
            fail(fields.place_of(kAxisNames[axis]), "a swing's range must hold 0");
    }
}

void read_translation(Fields& fields, AngleUnit unit, LimitRecord& limit) {
    const OrderedJson* value = fields.find("translation");
    if (value == nullptr) return;
    Fields translation(*value, fields.place_of("translation"), unit);
    for (std::size_t axis = 0; axis < 3; ++axis)
        translation.read_range(kAxisNames[axis], limit.translation_min[axis], limit.translation_max[axis]);
    translation.refuse_others();
}

void read_flag(Fields& fields, std::string_view key, std::uint8_t flag, LimitRecord& limit) {
    bool is_set = false;
    fields.read(key, is_set);
    if (is_set) limit.flags |= flag;
}

}  // namespace

void check_limit_at(const LimitRecord& limit, const std::string& place) {
    LimitRecord admitted = limit;
    admitted.flags |= kRestOutside;
    Faults faults;
    check_limit(admitted, 0, 0, faults);
    if (!faults.empty()) fail(place, describe(faults.list().front()));
}

LimitRecord parse_limit(const OrderedJson& value, const std::string& place, AngleUnit unit) {
    Fields fields(value, place, unit);
    LimitRecord limit;
    fields.need("model");
    fields.read_word("model", kModelNames, limit.model);
    const auto model = static_cast<LimitModel>(limit.model);
    if (model == LimitModel::euler_box) {
        fields.read_word("order", kOrderNames, limit.euler_order);
    } else {
        refuse(fields, "order", model);
    }
    fields.read_word("scope", kScopeNames, limit.scope);
    fields.read_rotation("frame", limit.frame);
    read_rotation_limits(fields, model, limit);
    read_translation(fields, unit, limit);
    fields.read("stiffness", limit.stiffness, 0.0f, 1.0f);
    fields.read_angles("preferred", limit.preferred);
    fields.read_angle("soft_zone", limit.soft_zone);
    if (limit.soft_zone < 0.0f) fail(fields.place_of("soft_zone"), "it is less than 0");
    read_flag(fields, "approximated", kApproximated, limit);
    read_flag(fields, "proposed", kProposed, limit);
    read_flag(fields, "rest_outside", kRestOutside, limit);
    fields.refuse_others();
    check_limit_at(limit, place);
    return limit;
}

std::vector<LimitRecord> parse_limits(const OrderedJson& value, const std::string& place, AngleUnit unit) {
    if (!value.is_array()) return {parse_limit(value, place, unit)};
    std::vector<LimitRecord> limits;
    std::bitset<kLimitScopes> taken;
    for (std::size_t i = 0; i < value.size(); ++i) {
        const LimitRecord limit = parse_limit(value[i], at(place, i), unit);
        if (taken[limit.scope])
            fail(at(place, i), "there is a second constraint of scope " + std::string(kScopeNames[limit.scope]));
        taken.set(limit.scope);
        limits.push_back(limit);
    }
    return limits;
}

}  // namespace bendy::converter
