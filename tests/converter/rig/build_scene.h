#pragma once

#include "rigging/rig/attach_rig.h"
#include "rigging/rig/parse_rig.h"
#include "scene/failure.h"

#include <bendy/converter/scene.h>

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace bendy::converter::test {

/// A joint to be: its parent comes before it in pre-order.
struct JointPlan {
    std::string name;
    std::uint32_t parent = kNone;
    glm::vec3 translation{0.0f};
    glm::vec4 rotation{0.0f, 0.0f, 0.0f, 1.0f};
};

inline Scene make_scene(const std::vector<JointPlan>& plans) {
    Scene scene;
    for (const JointPlan& plan : plans) {
        Joint joint;
        joint.name = plan.name;
        joint.parent = plan.parent;
        joint.rest.translation = plan.translation;
        joint.rest.rotation = plan.rotation;
        scene.joints.push_back(std::move(joint));
    }
    return scene;
}

/// Joints in a row, each a metre up from the one before.
inline Scene make_row(const std::vector<std::string>& names) {
    std::vector<JointPlan> plans;
    for (const std::string& name : names)
        plans.push_back({name,
                         plans.empty() ? kNone : static_cast<std::uint32_t>(plans.size() - 1),
                         {0.0f, plans.empty() ? 0.0f : 1.0f, 0.0f}});
    return make_scene(plans);
}

/// What work fails with: "place: message"; or "no error".
template <class Work>
std::string failure_of(Work work) {
    try {
        work();
    } catch (const Failure& failure) {
        return failure.error.place.empty() ? failure.error.message : failure.error.place + ": " + failure.error.message;
    }
    return "no error";
}

/// A rig file around these members.
inline std::string rig_text(const std::string& members) {
    return R"({"bendy_rig": 1, )" + members + "}";
}

inline Rig parse(const std::string& members) {
    Report report;
    return parse_rig(rig_text(members), report);
}

inline std::string rig_error(const std::string& members) {
    return failure_of([&] { parse(members); });
}

/// Attaches a rig file's members to a scene with nothing claimed.
inline void attach(Scene& scene, const std::string& members, Report& report) {
    const JointIndex index(scene);
    Claims claims{std::vector<bool>(scene.joints.size()), {}};
    attach_rig(scene, parse(members), index, claims, report);
}

/// "place: message (count times)" of each warning.
inline std::vector<std::string> lines_of(const Report& report) {
    std::vector<std::string> lines;
    for (const Warning& warning : report.warnings()) {
        lines.push_back(warning.first_place + ": " + warning.message);
        if (warning.count > 1) lines.back() += " (" + std::to_string(warning.count) + " times)";
    }
    return lines;
}

}  // namespace bendy::converter::test
