#include "proposal_lines.h"

#include <bendy/format/trig.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace bendy::converter {
namespace {

/// Whole degrees of radians.
std::string degrees(float radians) {
    const double exact = static_cast<double>(radians) * 180.0 / trig::kPi;
    return std::to_string(std::lround(exact + (exact < 0.0 ? -1e-4 : 1e-4)));  // a float's half degrees go outward
}

std::string range_of(const LimitRecord& limit, std::size_t axis) {
    return degrees(limit.rotation_min[axis]) + " to " + degrees(limit.rotation_max[axis]);
}

/// With so many decimals; no locale.
std::string decimals(double number, int places) {
    const double power = places == 1 ? 10.0 : 100.0;
    const long long whole = std::llround(std::abs(number) * power);
    const auto unit = static_cast<long long>(power);
    std::string fraction = std::to_string(whole % unit);
    fraction.insert(0, static_cast<std::size_t>(places) - fraction.size(), '0');
    return (number < 0.0 && whole != 0 ? "-" : "") + std::to_string(whole / unit) + '.' + fraction;
}

std::string vector_of(const glm::dvec3& v) {
    return '(' + decimals(v.x, 2) + ", " + decimals(v.y, 2) + ", " + decimals(v.z, 2) + ')';
}

std::string clips_of(std::uint32_t clips) {
    return clips == 1 ? "1 clip" : std::to_string(clips) + " clips";
}

std::string part_of(const JointAnatomy& anatomy) {
    constexpr std::array<const char*, 10> kWords{"collarbone", "shoulder", "elbow", "wrist", "hip",
                                                 "knee",       "ankle",    "toes",  "spine", "neck"};
    std::string words = kWords.at(static_cast<std::size_t>(anatomy.part));
    if (anatomy.part == HumanJoint::spine || anatomy.part == HumanJoint::neck)
        return anatomy.number == 0 ? words : words + ' ' + std::to_string(anatomy.number);
    return (anatomy.is_right ? "right " : "left ") + words;
}

std::string way_of(const glm::dvec3& way, const Stance& stance) {
    const std::array<std::pair<double, const char*>, 6> ways{{{glm::dot(way, stance.forward), "forward"},
                                                              {-glm::dot(way, stance.forward), "backward"},
                                                              {glm::dot(way, stance.up), "up"},
                                                              {-glm::dot(way, stance.up), "down"},
                                                              {glm::dot(way, stance.left), "left"},
                                                              {-glm::dot(way, stance.left), "right"}}};
    const auto first =
        std::max_element(ways.begin(), ways.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::string words = first->second;
    const std::pair<double, const char*>* second = nullptr;
    for (const auto& candidate : ways) {
        if (&candidate != first && (second == nullptr || candidate.first > second->first)) second = &candidate;
    }
    if (second->first > 0.5) words += std::string(" and ") + second->second;
    return words;
}

}  // namespace

std::string name_of(const Scene& scene, std::uint32_t joint) {
    const std::string& name = scene.joints[joint].name;
    return name.empty() ? '#' + std::to_string(joint) : name;
}

std::string line_of(const Scene& scene, const Chain& chain, const std::optional<ProposedBend>& bend,
                    const Stance& stance) {
    constexpr std::array<const char*, kSolvers> kNames{"any",    "pull", "two_bone",     "ccd",
                                                       "fabrik", "aim",  "least_squares"};
    constexpr std::size_t kShown = 12;
    std::vector<bool> is_passive(scene.joints.size());
    for (const Chain::Weight& weight : chain.weights) is_passive[weight.joint] = weight.weight == 0.0f;
    std::vector<std::uint32_t> joints = path_of(scene, chain.record.start, chain.record.effector);
    joints.erase(std::remove_if(joints.begin(), joints.end(), [&](std::uint32_t joint) { return is_passive[joint]; }),
                 joints.end());
    std::string line = "chain " + chain.name + ": ";
    for (std::size_t i = 0; i < joints.size(); ++i) {
        if (i > 0) line += " > ";
        if (joints.size() > kShown && i == kShown - 1) {
            line += "... > ";
            i = joints.size() - 1;
        }
        line += name_of(scene, joints[i]);
    }
    if (chain.record.target != kNone) line += " to " + name_of(scene, chain.record.target);
    line += std::string(", ") + kNames.at(chain.record.solver);
    if (!bend) return line;
    const bool is_arm = chain.name.find("Arm") != std::string::npos;
    line += std::string(is_arm ? ", elbow" : ", knee") + " points " + way_of(bend->way, stance);
    return bend->clips == 0 ? line : line + " as in " + clips_of(bend->clips);
}

std::string line_of(const Scene& scene, const ProposedLimit& proposed) {
    const LimitRecord& limit = proposed.limit;
    std::string line = part_of(proposed.anatomy) + ", " + name_of(scene, proposed.anatomy.joint) + ": ";
    const auto model = static_cast<LimitModel>(limit.model);
    if (model == LimitModel::hinge) {
        line += "hinge about " + vector_of(proposed.axis) + ", " + range_of(limit, 0) + " degrees";
    } else if (bends(proposed.anatomy.part)) {
        line += "bends " + range_of(limit, 2) + " degrees about " + vector_of(proposed.axis) + ", sideways " +
                range_of(limit, 1) + ", twist " + range_of(limit, 0);
    } else {
        line += "swing " + range_of(limit, 1) + " and " + range_of(limit, 2) + " degrees, twist " + range_of(limit, 0);
    }
    if (proposed.is_axis_fitted) {
        line += ", axis fitted to " + clips_of(proposed.clips) + ", " + decimals(proposed.axis_off, 1) +
                " degrees off a human's";
    }
    if (proposed.growth > 0.05 && proposed.clips > 0) {
        line += ", up to " + std::to_string(std::lround(std::ceil(proposed.growth))) +
                " degrees wider than a human's for " + clips_of(proposed.clips);
    }
    return line;
}

}  // namespace bendy::converter
