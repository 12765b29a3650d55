#include "blender_limits.h"

#include "euler.h"
#include "failure.h"
#include "names.h"
#include "parse_limit.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace bendy::converter {
namespace {

constexpr float kFree = LimitRecord::kFree;
constexpr std::array<std::string_view, 5> kSpaceNames{"rest", "rest_with_parent", "armature", "world", "custom"};
enum class Space : std::uint8_t { rest, rest_with_parent, armature, world, custom };

/// Turns X to the bone's Y, along the bone: the twist axis; Y to its Z and Z to its X.
constexpr std::array<float, 4> kAlongBone{0.5f, 0.5f, 0.5f, 0.5f};
constexpr std::array<std::size_t, 3> kBoneAxis{1, 2, 0};  ///< the bone's axis for X, Y, Z of that frame

struct Box {
    std::array<float, 3> low{-kFree, -kFree, -kFree};
    std::array<float, 3> high{kFree, kFree, kFree};

    /// Takes what both allow; false, and unchanged, if that is nothing.
    bool intersect(const Box& other) {
        Box both;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            both.low[axis] = std::max(low[axis], other.low[axis]);
            both.high[axis] = std::min(high[axis], other.high[axis]);
            if (both.low[axis] > both.high[axis]) return false;
        }
        *this = both;
        return true;
    }
};

/// A Limit Rotation or Limit Location.
struct Source {
    std::string place;
    Space space = Space::rest;
    std::array<float, 4> zero{-0.70710678f, 0.0f, 0.0f, 0.70710678f};  ///< the orientation whose angles are 0
    std::uint8_t order = 0;
    float influence = 1.0f;
    Box box;
};

std::vector<Source> read_sources(Fields& fields, std::string_view key, bool is_rotation) {
    std::vector<Source> sources;
    const OrderedJson* list = fields.find(key);
    if (list == nullptr) return sources;
    need_list(*list, fields.place_of(key));
    for (std::size_t i = 0; i < list->size(); ++i) {
        Source source;
        source.place = at(fields.place_of(key), i);
        Fields one((*list)[i], source.place, AngleUnit::radians);
        auto space = static_cast<std::uint8_t>(Space::rest);
        one.read_word("space", kSpaceNames, space);
        source.space = static_cast<Space>(space);
        if (is_rotation) one.read_word("order", kOrderNames, source.order);
        one.read_rotation("zero", source.zero);
        one.read("influence", source.influence, 0.0f, 1.0f);
        for (std::size_t axis = 0; axis < 3; ++axis)
            one.read_range(kAxisNames[axis], source.box.low[axis], source.box.high[axis]);
        if (source.influence > 0.0f) sources.push_back(std::move(source));
    }
    return sources;
}

void approximate(LimitRecord& limit, const std::string& what, const std::string& place, Report& report) {
    limit.flags |= kApproximated;
    report.warn(what, place);
}

void note_influence(const Source& source, LimitRecord& limit, Report& report) {
    if (source.influence != 1.0f) {
        approximate(limit, "a limit with an influence of less than 1 counts in full", source.place + ".influence",
                    report);
    }
}

/// Where a box limits not the bone's rotation q but r q conj(zero), r the bone's rest orientation in the box's space.
/// That is D Q with D = r conj(zero) and Q = zero q conj(zero). With D as R(last) R(middle) R(first), the frame that
/// turns the first back leaves a box for Q that D's angles shift; exactly so if the middle angle is zero. False where
/// that one is too large for the box to resemble what was meant.
bool shift_box(const Rotation& rest, const Rotation& zero, LimitRecord& limit) {
    constexpr double kResembles = std::numbers::pi / 3.0;
    const auto order = static_cast<EulerOrder>(limit.euler_order);
    const auto [first, middle, last] = axes_of(order);
    const std::array<double, 3> angles = to_euler(rest * glm::conjugate(zero), order);
    if (std::abs(angles[middle]) > kResembles) return false;
    glm::dvec3 axis(0.0);
    axis[static_cast<int>(first)] = 1.0;
    limit.frame = to_record(glm::conjugate(zero) * glm::angleAxis(-angles[first], axis));
    for (std::size_t i = 0; i < 3; ++i) {
        float& low = limit.rotation_min[i];
        float& high = limit.rotation_max[i];
        const double low_there = low - angles[i];
        const double high_there = high - angles[i];
        const bool is_bounded = std::isfinite(low_there) && std::isfinite(high_there);
        const double turn =
            is_bounded ? 2.0 * std::numbers::pi * std::round((low_there + high_there) / (4.0 * std::numbers::pi)) : 0.0;
        low = static_cast<float>(low_there - turn);
        high = static_cast<float>(high_there - turn);
    }
    return true;
}

/// False where the space cannot be held.
bool place_box(const Source& source, const BoneAxes& bone, LimitRecord& limit, Report& report) {
    if (source.space == Space::rest) return true;
    if (source.space == Space::custom) return false;
    approximate(limit, "a rotation limit counts the parents' motion in Blender, and does not here", source.place,
                report);
    if (source.space == Space::rest_with_parent) return true;
    const Rotation& rest = source.space == Space::world ? bone.in_file : bone.in_armature;
    return shift_box(rest, to_rotation(source.zero), limit);
}

std::optional<LimitRecord> read_rotation_box(Fields& fields, const BoneAxes& bone, Report& report) {
    std::optional<LimitRecord> limit;
    Source first;
    for (Source& source : read_sources(fields, "euler_limits", true)) {
        if (!limit) {
            limit.emplace();
            limit->model = static_cast<std::uint8_t>(LimitModel::euler_box);
            limit->euler_order = source.order;
            first = std::move(source);
            note_influence(first, *limit, report);
            continue;
        }
        note_influence(source, *limit, report);
        const bool is_alike = source.space == first.space && source.order == first.order;
        if (!is_alike || !first.box.intersect(source.box)) {
            approximate(*limit, "of several rotation limits that do not go together the first counts", source.place,
                        report);
        }
    }
    if (!limit) return limit;
    limit->rotation_min = first.box.low;
    limit->rotation_max = first.box.high;
    if (place_box(first, bone, *limit, report)) return limit;
    report.warn("a rotation limit in space " + std::string(kSpaceNames[static_cast<std::size_t>(first.space)]) +
                    " left out: it cannot be held in the joint's rest space",
                first.place);
    return std::nullopt;
}

/// The limits and stiffness of Blender's IK solver.
std::optional<LimitRecord> read_ik_limits(Fields& fields) {
    std::optional<LimitRecord> limit;
    const OrderedJson* value = fields.find("swing_twist");
    if (value != nullptr) {
        limit.emplace();
        limit->model = static_cast<std::uint8_t>(LimitModel::swing_twist_ellipse);
        limit->frame = kAlongBone;
        Fields ranges(*value, fields.place_of("swing_twist"), AngleUnit::radians);
        constexpr std::array<std::string_view, 3> kRanges{"twist_y", "swing_z", "swing_x"};
        for (std::size_t axis = 0; axis < 3; ++axis)
            ranges.read_angle_range(kRanges[axis], limit->rotation_min[axis], limit->rotation_max[axis]);
        constexpr std::array<float, 3> kZeros{};
        if (limit->rotation_min == kZeros && limit->rotation_max == kZeros) {
            *limit = LimitRecord{};
            limit->model = static_cast<std::uint8_t>(LimitModel::locked);
        }
    }
    std::array<float, 3> stiffness{};
    fields.read("stiffness", stiffness, 0.0f, 1.0f);
    if (stiffness != std::array<float, 3>{}) {
        if (!limit) limit.emplace();
        const bool is_along = limit->frame == kAlongBone;
        for (std::size_t axis = 0; axis < 3; ++axis)
            limit->stiffness[axis] = stiffness[is_along ? kBoneAxis[axis] : axis];
    }
    if (!limit) return limit;
    limit->scope = static_cast<std::uint8_t>(LimitScope::ik_only);
    check_limit_at(*limit, fields.place_of("swing_twist"));
    return limit;
}

/// Limits of the place, along the bone's axes: a free model with nothing else.
std::optional<LimitRecord> read_location_box(Fields& fields, Report& report) {
    std::optional<LimitRecord> limit;
    Box box;
    for (const Source& source : read_sources(fields, "location_limits", false)) {
        if (source.space != Space::rest) {
            report.warn("a location limit in another space than the joint's rest space left out", source.place);
            continue;
        }
        if (!limit) limit.emplace();
        note_influence(source, *limit, report);
        if (!box.intersect(source.box)) {
            approximate(*limit, "of several location limits that do not go together the first counts", source.place,
                        report);
        }
    }
    if (!limit) return limit;
    limit->translation_min = box.low;
    limit->translation_max = box.high;
    return limit;
}

}  // namespace

std::vector<LimitRecord> read_blender_limits(Fields& fields, const BoneAxes& bone, Report& report) {
    std::optional<LimitRecord> rotation = read_rotation_box(fields, bone, report);
    const std::optional<LimitRecord> ik = read_ik_limits(fields);
    std::optional<LimitRecord> location = read_location_box(fields, report);

    // Blender's constraints do not hold its IK solver back, which has limits of its own; where it has none, these
    // serve.
    if (rotation && ik) rotation->scope = static_cast<std::uint8_t>(LimitScope::all_but_ik);
    if (rotation && location) {
        if (rotation->frame == LimitRecord{}.frame) {
            rotation->translation_min = location->translation_min;
            rotation->translation_max = location->translation_max;
            rotation->flags |= location->flags;
            location.reset();
        } else if (!ik) {
            location->scope = static_cast<std::uint8_t>(LimitScope::all_but_ik);  // the solver moves no joint
        }
    }
    bool is_approximated = false;
    fields.read("approximated", is_approximated);
    std::vector<LimitRecord> limits;
    for (const auto& limit : {rotation, ik, location}) {
        if (!limit) continue;
        limits.push_back(*limit);
        if (is_approximated) limits.back().flags |= kApproximated;
    }
    return limits;
}

}  // namespace bendy::converter
