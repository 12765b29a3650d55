#include "missing_roles.h"

#include "clip_rotations.h"
#include "find_humanoid.h"
#include "scene/failure.h"
#include "scene/rest_frames.h"

#include <bendy/format/records.h>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace bendy::converter {
namespace {

std::optional<Limb> limb_of(const RoleRecord& record) {
    const auto role = static_cast<Role>(record.role);
    for (const Limb limb : {Limb::left_arm, Limb::right_arm, Limb::left_leg, Limb::right_leg}) {
        const LimbBones bones = bones_of(limb);
        if (role == bones.upper || role == bones.lower || role == bones.end) return limb;
    }
    return std::nullopt;
}

/// A part of a limb: the joint with a role at its end, the next one with a role above it, and those between.
struct LimbPart {
    const RoleRecord* top = nullptr;
    const RoleRecord* end = nullptr;
    std::vector<std::uint32_t> between;
};

std::vector<LimbPart> parts_with_more_joints(const Scene& scene) {
    std::vector<const RoleRecord*> roles(scene.joints.size(), nullptr);
    for (const RoleRecord& role : scene.roles) roles[role.joint] = &role;
    std::vector<LimbPart> parts;
    for (const RoleRecord& end : scene.roles) {
        const std::optional<Limb> limb = limb_of(end);
        if (!limb) continue;
        LimbPart part{nullptr, &end, {}};
        std::uint32_t above = scene.joints[end.joint].parent;
        for (; above != kNone && roles[above] == nullptr; above = scene.joints[above].parent)
            part.between.push_back(above);
        if (part.between.empty() || above == kNone || limb_of(*roles[above]) != limb) continue;
        part.top = roles[above];
        parts.push_back(std::move(part));
    }
    return parts;
}

/// How far the clips move joints, from one end of their motion to the other; degrees.
class Moves {
public:
    explicit Moves(const Scene& scene) : rest_(scene), clips_(scene) {}

    [[nodiscard]] double turn(std::uint32_t joint) const {
        return largest(joint, [](const glm::dquat& a, const glm::dquat& b) {
            const double cosine = std::min(std::abs(glm::dot(a, b)), 1.0);
            return degrees_of(std::sqrt(1.0 - cosine * cosine));
        });
    }

    /// How far the bone from the joint to the end of the part swings; twist does not count.
    [[nodiscard]] double swing(std::uint32_t joint, const LimbPart& part) const {
        const glm::dvec3 end = rest_.position(part.end->joint);
        const glm::dvec3 whole = end - rest_.position(part.top->joint);
        const glm::dvec3 bone = end - rest_.position(joint);
        const bool is_at_end = glm::length(bone) < 0.05 * glm::length(whole);
        const auto axis = rest_.to_space_of(joint, is_at_end ? whole : bone);
        if (!axis) return 0.0;
        return largest(joint, [&](const glm::dquat& a, const glm::dquat& b) {
            return degrees_of(std::min(0.5 * glm::distance(a * *axis, b * *axis), 1.0));
        });
    }

private:
    template <class Angle>
    [[nodiscard]] double largest(std::uint32_t joint, Angle angle) const {
        const Rotations keys = clips_.of(joint).rotations;
        if (keys.empty()) return 0.0;
        const auto farthest_from = [&](const glm::dquat& from) {
            return std::max_element(keys.begin(), keys.end(), [&](const glm::dquat& a, const glm::dquat& b) {
                return angle(from, a) < angle(from, b);
            });
        };
        const glm::dquat end = *farthest_from(keys.front());
        return angle(end, *farthest_from(end));
    }

    RestFrames rest_;
    ClipRotations clips_;
};

/// \param still  the role of the joint that turns by so many degrees only, while this one swings
std::string warning_of(const Scene& scene, std::uint32_t joint, const RoleRecord& still, double swing, double turn) {
    const auto shown = [](double degrees) { return std::to_string(std::lround(degrees)); };
    const std::string name = quote(scene.joints[joint].name);
    const std::string role(kValueNames<Role>[still.role]);
    return "joint " + name + " has no role but swings by " + shown(swing) + " degrees; the " + role + ", " +
           quote(scene.joints[still.joint].name) + ", turns by " + shown(turn) + ". If " + name + " is the " + role +
           R"(, say so in a rig file (--rig), as in {"bendy_rig": 1, "roles": {")" + role + R"(": "#)" +
           std::to_string(joint) + "\"}}";
}

}  // namespace

void warn_of_missing_roles(const Scene& scene, Report& report) {
    constexpr double kSwing = 15.0;  // degrees
    constexpr double kHardly = 1.0 / 3.0;
    const std::vector<LimbPart> parts = parts_with_more_joints(scene);
    if (parts.empty() || scene.clips.empty()) return;
    const Moves moves(scene);
    for (const LimbPart& part : parts) {
        const double of_top = moves.turn(part.top->joint);
        const double of_end = moves.turn(part.end->joint);
        const RoleRecord& still = of_top < of_end ? *part.top : *part.end;
        for (const std::uint32_t joint : part.between) {
            const double swing = moves.swing(joint, part);
            if (swing < kSwing || std::min(of_top, of_end) > kHardly * swing) continue;
            report.warn(warning_of(scene, joint, still, swing, std::min(of_top, of_end)));
        }
    }
}

}  // namespace bendy::converter
