#include "attach_rig.h"
#include "scene/json_text.h"

#include <bendy/format/constraint.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace bendy::converter {
namespace {

constexpr const char* kName = "AGI_articulations";

enum class Motion : std::uint8_t { translate, rotate, scale };

struct Stage {
    Motion motion = Motion::rotate;
    std::size_t axis = 0;
    double low = 0.0;  ///< degrees or metres
    double high = 0.0;
    double initial = 0.0;
};

struct Articulation {
    std::vector<Stage> stages;
    std::string place;
};

bool is_number(const Json& object, const char* key, double& value) {
    const auto member = object.find(key);
    if (member == object.end() || !member->is_number()) return false;
    value = member->get<double>();
    return std::isfinite(value);
}

std::optional<std::string> text_of(const Json& object, const char* key) {
    if (!object.is_object()) return std::nullopt;
    const auto member = object.find(key);
    if (member == object.end() || !member->is_string()) return std::nullopt;
    return member->get<std::string>();
}

/// Parses `xRotate`, `uniformScale`, ...
bool read_type(const std::string& type, Stage& stage) {
    if (type == "uniformScale") {
        stage.motion = Motion::scale;
        return true;
    }
    constexpr std::array<std::pair<std::string_view, Motion>, 3> kMotions{
        {{"Translate", Motion::translate}, {"Rotate", Motion::rotate}, {"Scale", Motion::scale}}};
    if (type.empty() || type[0] < 'x' || type[0] > 'z') return false;
    stage.axis = static_cast<std::size_t>(type[0] - 'x');
    for (const auto& [name, motion] : kMotions) {
        if (std::string_view(type).substr(1) != name) continue;
        stage.motion = motion;
        return true;
    }
    return false;
}

std::optional<Stage> read_stage(const Json& json, const std::string& place, Report& report) {
    const auto refuse = [&](const char* why) {
        report.warn(std::string("articulation left out: a stage ") + why, place);
        return std::nullopt;
    };
    const std::optional<std::string> type = text_of(json, "type");
    Stage stage;
    if (!type || !read_type(*type, stage)) return refuse("has none of the types of AGI_articulations");
    if (!is_number(json, "minimumValue", stage.low) || !is_number(json, "maximumValue", stage.high) ||
        !is_number(json, "initialValue", stage.initial)) {
        return refuse("has no minimumValue, maximumValue and initialValue that are numbers");
    }
    if (stage.low > stage.high) return refuse("has a minimumValue above its maximumValue");
    if (stage.initial < stage.low || stage.initial > stage.high) {
        report.warn("initialValue of a stage is outside its range", place);
        stage.initial = std::clamp(stage.initial, stage.low, stage.high);
    }
    return stage;
}

std::optional<Articulation> read_articulation(const Json& json, std::string place, Report& report) {
    const auto stages = json.find("stages");
    if (stages == json.end() || !stages->is_array()) {
        report.warn("articulation left out: its stages are not an array", place);
        return std::nullopt;
    }
    Articulation result;
    for (std::size_t i = 0; i < stages->size(); ++i) {
        const auto stage = read_stage((*stages)[i], place + ".stages[" + std::to_string(i) + ']', report);
        if (!stage) return std::nullopt;
        result.stages.push_back(*stage);
    }
    if (json.contains("pointingVector"))
        report.warn("pointingVector of articulations is kept as JSON, not interpreted", place);
    result.place = std::move(place);
    return result;
}

std::map<std::string, Articulation> read_articulations(const Json& extension, Report& report) {
    std::map<std::string, Articulation> by_name;
    const std::string root = std::string("extensions.") + kName;
    const bool has_list = extension.is_object() && extension.contains("articulations");
    if (!has_list || !extension["articulations"].is_array()) {
        report.warn("articulations left out: they must be an array", root + ".articulations");
        return by_name;
    }
    const Json& list = extension["articulations"];
    for (std::size_t i = 0; i < list.size(); ++i) {
        const std::string place = root + ".articulations[" + std::to_string(i) + ']';
        const std::optional<std::string> name = text_of(list[i], "name");
        if (!name) {
            report.warn("articulation without a name left out", place);
            continue;
        }
        if (by_name.count(*name) != 0) {
            report.warn("articulation with a duplicate name left out", place);
            continue;
        }
        if (auto articulation = read_articulation(list[i], place, report))
            by_name.emplace(*name, *std::move(articulation));
    }
    return by_name;
}

/// The combined motion of the stages, by axis of the joint.
struct Motions {
    std::array<std::optional<Stage>, 3> turns;   ///< degrees
    std::array<std::optional<Stage>, 3> shifts;  ///< metres, in the joint's scale
    std::vector<std::size_t> order;              ///< axes of the turns; the first multiplies first
    bool is_exact = true;
};

Motions gather(const Articulation& articulation, Report& report) {
    Motions motions;
    for (const Stage& stage : articulation.stages) {
        if (stage.motion == Motion::scale) {
            report.warn("scale stages of articulations are not limited", articulation.place);
            motions.is_exact = false;
            continue;
        }
        const bool is_turn = stage.motion == Motion::rotate;
        std::optional<Stage>& known = (is_turn ? motions.turns : motions.shifts)[stage.axis];
        // A translation after a turn goes along turned axes; so does one between turns.
        if (!is_turn && !motions.order.empty()) {
            motions.is_exact = false;
            report.warn("articulation approximated: it translates after it rotates", articulation.place);
        }
        if (!known) {
            known = stage;
            if (is_turn) motions.order.push_back(stage.axis);
            continue;
        }
        // Shifts along one axis add up anywhere among the shifts; turns about one axis only if adjacent.
        if (is_turn && motions.order.back() != stage.axis) {
            motions.is_exact = false;
            report.warn("articulation approximated: it rotates about one axis in several stages", articulation.place);
        }
        known->low += stage.low;
        known->high += stage.high;
        known->initial += stage.initial;
    }
    return motions;
}

/// The Euler order of the axes; an axis that does not turn may be anywhere.
EulerOrder order_of(std::vector<std::size_t> axes) {
    std::reverse(axes.begin(), axes.end());  // the one that multiplies last turns first
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (std::find(axes.begin(), axes.end(), axis) == axes.end()) axes.push_back(axis);
    }
    for (unsigned number = 0; number < kEulerOrders; ++number) {
        const auto order = static_cast<EulerOrder>(number);
        const std::array<std::size_t, 3> turning = axes_of(order);
        if (std::equal(axes.begin(), axes.end(), turning.begin())) return order;
    }
    return EulerOrder::xyz;
}

/// Clamps to the range of float: limits must be finite.
float as_float(double value) {
    constexpr double kMost = std::numeric_limits<float>::max();
    return static_cast<float>(std::clamp(value, -kMost, kMost));
}

bool has_even_scale(const Transform& rest) {
    const auto near = [&](float value) { return std::abs(value - rest.scale.x) <= 1e-4f * std::abs(rest.scale.x); };
    return near(rest.scale.y) && near(rest.scale.z) && rest.shear == glm::vec3(0.0f);
}

ConstraintRecord to_limit(const Articulation& articulation, const Joint& joint, Report& report) {
    Motions motions = gather(articulation, report);
    ConstraintRecord constraint;
    // X of the frame is the hinge's axis: frame axis i is the joint's axis (i + first) % 3, so no sign changes.
    std::size_t first = 0;
    if (motions.order.size() == 1) {
        first = motions.order.front();
        constraint.model = static_cast<std::uint8_t>(ConstraintModel::hinge);
        constexpr std::array<std::array<float, 4>, 3> kFrames{
            {{0.0f, 0.0f, 0.0f, 1.0f}, {0.5f, 0.5f, 0.5f, 0.5f}, {-0.5f, -0.5f, -0.5f, 0.5f}}};
        constraint.frame = kFrames[first];
    } else if (motions.order.empty()) {
        constraint.model = static_cast<std::uint8_t>(ConstraintModel::locked);
    } else {
        constraint.model = static_cast<std::uint8_t>(ConstraintModel::euler_box);
        constraint.euler_order = static_cast<std::uint8_t>(order_of(motions.order));
    }
    constexpr double kDegree = std::numbers::pi / 180.0;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t axis = (i + first) % 3;
        const Stage turn = motions.turns[axis].value_or(Stage{});
        const Stage shift = motions.shifts[axis].value_or(Stage{});
        constraint.rotation_min[i] = as_float(turn.low * kDegree);
        constraint.rotation_max[i] = as_float(turn.high * kDegree);
        constraint.preferred[i] = as_float(turn.initial * kDegree);
        // The stages stand to the right of the node's matrix, so its scale applies to them.
        const auto scale = static_cast<double>(joint.rest.scale[static_cast<int>(axis)]);
        const auto [low, high] = std::minmax({shift.low * scale, shift.high * scale});
        constraint.translation_min[i] = as_float(low);
        constraint.translation_max[i] = as_float(high);
    }
    if (!has_even_scale(joint.rest)) motions.is_exact = false;
    if (!motions.is_exact) constraint.flags |= kApproximated;
    if (!holds_rest(constraint)) constraint.flags |= kRestOutside;
    return constraint;
}

std::optional<std::string> articulation_of(const Joint& joint, Report& report) {
    if (joint.extensions.find(kName) == std::string::npos) return std::nullopt;
    const Json extensions = Json::parse(joint.extensions).value_or(Json());
    if (!extensions.is_object() || !extensions.contains(kName)) return std::nullopt;
    std::optional<std::string> name = text_of(extensions[kName], "articulationName");
    const bool is_attach_point = extensions[kName].is_object() && extensions[kName].contains("isAttachPoint");
    if (!name && !is_attach_point) report.warn("node without a name of an articulation", joint.name);
    return name;
}

}  // namespace

void add_articulations(Scene& scene, const std::vector<bool>& claimed, Report& report) {
    if (scene.extensions.find(kName) == std::string::npos) return;
    const Json extensions = Json::parse(scene.extensions).value_or(Json());
    if (!extensions.is_object() || !extensions.contains(kName)) return;
    const std::map<std::string, Articulation> articulations = read_articulations(extensions[kName], report);
    for (std::size_t number = 0; number < scene.joints.size(); ++number) {
        Joint& joint = scene.joints[number];
        const std::optional<std::string> name = articulation_of(joint, report);
        if (!name) continue;
        const auto articulation = articulations.find(*name);
        if (articulation == articulations.end()) {
            report.warn("node of an articulation that does not exist", joint.name);
        } else if (joint.constraints.empty() && (claimed.empty() || !claimed[number])) {
            joint.constraints.push_back(to_limit(articulation->second, joint, report));
        }
    }
}

}  // namespace bendy::converter
