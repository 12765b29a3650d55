#include "limb_chains.h"

#include "scene/space.h"

#include <bendy/format/trig.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace bendy::converter {
namespace {

struct NamedLimb {
    const char* name;
    HumanBone start, middle, effector;
    double bends;  ///< 1 forward, -1 backward
};
constexpr std::array kNamedLimbs{
    NamedLimb{"LeftArm", HumanBone::left_upper_arm, HumanBone::left_lower_arm, HumanBone::left_hand, -1.0},
    NamedLimb{"RightArm", HumanBone::right_upper_arm, HumanBone::right_lower_arm, HumanBone::right_hand, -1.0},
    NamedLimb{"LeftLeg", HumanBone::left_upper_leg, HumanBone::left_lower_leg, HumanBone::left_foot, 1.0},
    NamedLimb{"RightLeg", HumanBone::right_upper_leg, HumanBone::right_lower_leg, HumanBone::right_foot, 1.0},
};

/// The direction in which the limb bends, in the space of start's parent; zeros if there is none.
std::array<float, 3> pole_of(const Scene& scene, const RestFrames& rest, const NamedLimb& limb,
                             const Humanoid& humanoid, const Stance& stance) {
    const std::uint32_t start = humanoid[limb.start];
    const std::uint32_t effector = humanoid[limb.effector];
    std::optional<glm::dvec3> bend;
    if (humanoid.has(limb.middle)) bend = bend_of(rest, start, humanoid[limb.middle], rest.position(effector));
    const std::optional<glm::dvec3> along = rest.direction(start, effector);
    if (!bend && along) bend = unit_across(limb.bends * stance.forward, *along);
    if (!bend) return {};
    const std::optional<glm::dvec3> pole = rest.to_space_of(scene.joints[start].parent, *bend);
    return pole ? to_array<3>(*pole) : std::array<float, 3>{};
}

Chain make_limb(const Scene& scene, const RestFrames& rest, const NamedLimb& limb, const Humanoid& humanoid,
                const Stance& stance, std::uint8_t flags) {
    const std::uint32_t start = humanoid[limb.start];
    const std::uint32_t effector = humanoid[limb.effector];
    const std::uint32_t middle = humanoid[limb.middle];
    Chain chain = make_chain(limb.name, start, effector, Solver::two_bone, flags);
    chain.record.pole_vector = pole_of(scene, rest, limb, humanoid, stance);
    const std::vector<std::uint32_t> path = path_of(scene, start, effector);
    if (std::find(path.begin(), path.end(), middle) == path.end() || middle == start || middle == effector) {
        if (path.size() != 3) chain.record.solver = static_cast<std::uint8_t>(Solver::any);
        return chain;
    }
    for (const std::uint32_t joint : path) {
        if (joint != start && joint != middle && joint != effector) chain.weights.push_back({joint, 0.0f});
    }
    return chain;
}

/// The chain from the first bone of the spine to the neck. The hips are excluded, because they carry the legs.
std::optional<Chain> make_spine(const Humanoid& humanoid, const RestFrames& rest, std::uint8_t flags) {
    const std::uint32_t start = humanoid[HumanBone::spine];
    if (start == kNone) return std::nullopt;
    for (const HumanBone end : {HumanBone::neck, HumanBone::head, HumanBone::upper_chest, HumanBone::chest}) {
        if (humanoid.has(end) && rest.is_below(humanoid[end], start))
            return make_chain("Spine", start, humanoid[end], Solver::ccd, flags);
    }
    return std::nullopt;
}

std::optional<Chain> make_head(const Humanoid& humanoid, const RestFrames& rest, const Stance& stance,
                               std::uint8_t flags) {
    const std::uint32_t head = humanoid[HumanBone::head];
    if (head == kNone || !humanoid.has(HumanBone::neck) || !rest.is_below(head, humanoid[HumanBone::neck]))
        return std::nullopt;
    Chain chain = make_chain("Head", humanoid[HumanBone::neck], head, Solver::aim, flags);
    if (const std::optional<glm::dquat> orientation = rest.orientation(head)) {
        const glm::dquat tip = glm::normalize(glm::conjugate(*orientation) *
                                              rotation_of_axes(glm::dmat3(stance.left, stance.up, stance.forward)));
        chain.record.tip_rotation = to_array<4>(glm::dvec4(tip.x, tip.y, tip.z, tip.w));
    }
    const std::uint32_t neck = humanoid[HumanBone::neck];
    const double length = glm::distance(rest.position(neck), rest.position(head));
    const auto ahead = rest.point_in_space_of(head, rest.position(neck) + length * stance.forward);
    if (ahead) chain.record.tip_offset = to_array<3>(*ahead);
    return chain;
}

}  // namespace

Chain make_chain(std::string name, std::uint32_t start, std::uint32_t effector, Solver solver, std::uint8_t flags) {
    Chain chain;
    chain.name = std::move(name);
    chain.record.start = start;
    chain.record.effector = effector;
    chain.record.solver = static_cast<std::uint8_t>(solver);
    chain.record.flags = flags;
    return chain;
}

std::vector<std::uint32_t> path_of(const Scene& scene, std::uint32_t start, std::uint32_t effector) {
    std::vector<std::uint32_t> path;
    for (std::uint32_t joint = effector; joint != kNone; joint = scene.joints[joint].parent) {
        path.push_back(joint);
        if (joint != start) continue;
        std::reverse(path.begin(), path.end());
        return path;
    }
    return {};
}

std::optional<glm::dvec3> bend_of(const RestFrames& rest, std::uint32_t start, std::uint32_t middle, glm::dvec3 end) {
    constexpr double kStraight = std::numbers::pi / 180.0;
    const std::optional<glm::dvec3> upper = rest.direction(start, middle);
    const std::optional<glm::dvec3> lower = unit(end - rest.position(middle));
    const std::optional<glm::dvec3> along = unit(end - rest.position(start));
    if (!upper || !lower || !along) return std::nullopt;
    const double bend = trig::atan2(glm::length(glm::cross(*upper, *lower)), glm::dot(*upper, *lower));
    return bend > kStraight ? unit_across(*upper, *along) : std::nullopt;
}

std::vector<Chain> make_limb_chains(const Scene& scene, const RestFrames& rest, const Humanoid& humanoid,
                                    const Stance& stance, std::uint8_t flags, const std::string& where,
                                    Report& report) {
    std::vector<Chain> chains;
    for (const NamedLimb& limb : kNamedLimbs) {
        const auto leave_out = [&](const std::string& why) {
            report.warn("chain " + std::string(limb.name) + " left out: " + why, where);
        };
        if (!humanoid.has(limb.start) || !humanoid.has(limb.effector)) {
            const HumanBone missing = humanoid.has(limb.start) ? limb.effector : limb.start;
            leave_out("there is no " + vrm_name(missing));
        } else if (!rest.is_below(humanoid[limb.effector], humanoid[limb.start])) {
            leave_out(vrm_name(limb.effector) + " is not below " + vrm_name(limb.start));
        } else {
            chains.push_back(make_limb(scene, rest, limb, humanoid, stance, flags));
        }
    }
    if (auto spine = make_spine(humanoid, rest, flags)) chains.push_back(*std::move(spine));
    if (auto head = make_head(humanoid, rest, stance, flags)) chains.push_back(*std::move(head));
    return chains;
}

std::vector<std::size_t> add_new_chains(Scene& scene, std::vector<Chain> chains) {
    std::vector<std::size_t> added;
    for (Chain& chain : chains) {
        if (std::any_of(scene.chains.begin(), scene.chains.end(), [&](const Chain& c) { return c.name == chain.name; }))
            continue;
        added.push_back(scene.chains.size());
        scene.chains.push_back(std::move(chain));
    }
    return added;
}

}  // namespace bendy::converter
