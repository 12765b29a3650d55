#include "auto_rig.h"

#include "anatomy.h"
#include "find_humanoid.h"
#include "fit_to_clips.h"
#include "limb_chains.h"
#include "rest_frames.h"
#include "vrm.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <numbers>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace bendy::converter {
namespace {

using Bone = HumanBone;

NamedHumanoid find(const Scene& scene, const RestFrames& rest) {
    Report said_before;  // when the extension's own chains were made
    if (const std::optional<VrmHumanoid> vrm = read_vrm_humanoid(scene, said_before)) {
        NamedHumanoid found;
        found.bones = vrm->bones;
        return found;
    }
    return find_humanoid(scene, rest);
}

/// How a character stands.
struct Posture {
    Stance stance;
    bool is_upright = false;  ///< the spine goes up from the legs, as a human's does
};

class Measurer {
public:
    Measurer(const RestFrames& rest, const NamedHumanoid& found) : rest_(rest), found_(found) {}

    /// Left is where the left limbs are, up where the spine goes or the legs come from, and forward follows; nothing if
    /// that gives no axes.
    [[nodiscard]] std::optional<Posture> measure() const {
        const auto arms = line(Bone::right_upper_arm, Bone::left_upper_arm);
        const auto legs = line(Bone::right_upper_leg, Bone::left_upper_leg);
        if (!arms && !legs) return std::nullopt;
        const auto left = unit((arms ? *arms : glm::dvec3(0.0)) + (legs ? *legs : glm::dvec3(0.0)));
        const auto stands = up_from_legs();
        const auto spine = up_spine();
        if (!left || (!stands && !spine)) return std::nullopt;
        Posture posture;
        posture.is_upright = !stands || !spine || glm::dot(*stands, *spine) > kUpright;
        const auto up = unit_across(posture.is_upright && spine ? *spine : *stands, *left);
        if (!up) return std::nullopt;
        posture.stance = {*left, *up, glm::cross(*left, *up)};
        return posture;
    }

    /// Whether toes point the way that left and right say is forward.
    [[nodiscard]] bool has_feet_forward(const Stance& stance) const {
        for (const auto& [foot, toes] :
             {std::pair(Bone::left_foot, Bone::left_toes), std::pair(Bone::right_foot, Bone::right_toes)}) {
            const auto direction = line(foot, toes);
            if (direction && glm::dot(*direction, stance.forward) < -0.3) return false;
        }
        return true;
    }

private:
    static constexpr double kUpright = 0.7;  // cosine: 45 degrees

    [[nodiscard]] std::optional<glm::dvec3> line(Bone from, Bone to) const {
        if (!found_.bones.has(from) || !found_.bones.has(to)) return std::nullopt;
        return rest_.direction(found_.bones[from], found_.bones[to]);
    }

    [[nodiscard]] std::optional<glm::dvec3> up_from_legs() const {
        glm::dvec3 sum(0.0);
        for (const auto& [upper, lower, end, loose] :
             {std::tuple(Bone::left_upper_leg, Bone::left_lower_leg, Bone::left_foot, 2),
              std::tuple(Bone::right_upper_leg, Bone::right_lower_leg, Bone::right_foot, 3)}) {
            if (!found_.bones.has(upper)) continue;
            std::uint32_t foot = found_.bones[end];
            if (foot == kNone) foot = found_.loose_ends[static_cast<std::size_t>(loose)];
            if (foot == kNone) foot = found_.bones[lower];
            if (foot == kNone) continue;
            if (const auto up = rest_.direction(foot, found_.bones[upper])) sum += *up;
        }
        return unit(sum);
    }

    [[nodiscard]] std::optional<glm::dvec3> up_spine() const {
        for (const Bone top : {Bone::neck, Bone::head}) {
            for (const Bone bottom : {Bone::hips, Bone::spine}) {
                if (const auto up = line(bottom, top)) return up;
            }
        }
        return std::nullopt;
    }

    const RestFrames& rest_;
    const NamedHumanoid& found_;
};

/// Chains for limbs whose hand or foot is moved by a rig of its own: their tip is where that one rests, it their
/// target.
std::vector<Chain> make_loose_chains(const Scene& scene, const RestFrames& rest, const NamedHumanoid& found) {
    struct Limb {
        const char* name;
        Bone upper, lower;
    };
    constexpr std::array<Limb, 4> kLimbs{Limb{"LeftArm", Bone::left_upper_arm, Bone::left_lower_arm},
                                         Limb{"RightArm", Bone::right_upper_arm, Bone::right_lower_arm},
                                         Limb{"LeftLeg", Bone::left_upper_leg, Bone::left_lower_leg},
                                         Limb{"RightLeg", Bone::right_upper_leg, Bone::right_lower_leg}};
    std::vector<Chain> chains;
    for (std::size_t i = 0; i < kLimbs.size(); ++i) {
        const std::uint32_t end = found.loose_ends[i];
        const std::uint32_t upper = found.bones[kLimbs[i].upper];
        const std::uint32_t lower = found.bones[kLimbs[i].lower];
        if (end == kNone || upper == kNone || lower == kNone) continue;
        const double thigh = glm::distance(rest.position(upper), rest.position(lower));
        const double shin = glm::distance(rest.position(lower), rest.position(end));
        if (!(shin > 0.3 * thigh) || !(shin < 3.0 * thigh)) continue;  // this is no end of that limb
        const auto tip = rest.point_in_space_of(lower, rest.position(end));
        const auto bend = bend_of(rest, upper, lower, rest.position(end));
        if (!tip) continue;
        Chain chain;
        chain.name = kLimbs[i].name;
        chain.record.start = upper;
        chain.record.effector = lower;
        chain.record.target = end;
        chain.record.solver = static_cast<std::uint8_t>(Solver::two_bone);
        chain.record.flags = kProposed;
        chain.record.tip_offset = {static_cast<float>(tip->x), static_cast<float>(tip->y), static_cast<float>(tip->z)};
        if (const auto pole = bend ? rest.to_space_of(scene.joints[upper].parent, *bend) : std::nullopt) {
            chain.record.pole_vector = {static_cast<float>(pole->x), static_cast<float>(pole->y),
                                        static_cast<float>(pole->z)};
        }
        for (const std::uint32_t joint : path_of(scene, upper, lower)) {
            if (joint != upper && joint != lower) chain.weights.push_back({joint, 0.0f});
        }
        chains.push_back(std::move(chain));
    }
    return chains;
}

// --- what is listed

std::string name_of(const Scene& scene, std::uint32_t joint) {
    const std::string& name = scene.joints[joint].name;
    return name.empty() ? '#' + std::to_string(joint) : name;
}

std::string degrees(float radians) {
    return std::to_string(std::lround(static_cast<double>(radians) * 180.0 / std::numbers::pi));
}

std::string range_of(const LimitRecord& limit, std::size_t axis) {
    return degrees(limit.rotation_min[axis]) + " to " + degrees(limit.rotation_max[axis]);
}

std::string line_of(const Scene& scene, const Chain& chain) {
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
    return line + ", " + kNames[chain.record.solver];
}

std::string line_of(const Scene& scene, const ProposedLimit& proposed) {
    const LimitRecord& limit = proposed.limit;
    std::string line = name_of(scene, proposed.joint);
    if (limit.model == static_cast<std::uint8_t>(LimitModel::hinge)) {
        line += ": hinge " + range_of(limit, 0) + " degrees";
    } else {
        line += ": swing_twist_ellipse, twist " + range_of(limit, 0) + ", swing " + range_of(limit, 1) + " and " +
                range_of(limit, 2) + " degrees";
    }
    return proposed.is_widened ? line + ", widened to its clips" : line;
}

}  // namespace

void auto_rig(Scene& scene, const std::vector<bool>& claimed, Report& report) {
    const RestFrames rest(scene);
    const NamedHumanoid found = find(scene, rest);
    const std::optional<Posture> posture = Measurer(rest, found).measure();
    if (!posture) return report.warn("auto-rig: no joints with the names of a human's limbs, nothing proposed");
    if (!Measurer(rest, found).has_feet_forward(posture->stance))
        return report.warn("auto-rig: the feet point backward from what left and right say, nothing proposed");

    Report unheard;  // of limbs that are not there
    std::vector<Chain> chains = make_limb_chains(scene, rest, found.bones, posture->stance, kProposed, {}, unheard);
    for (Chain& chain : make_loose_chains(scene, rest, found)) chains.push_back(std::move(chain));
    for (const std::size_t chain : add_new_chains(scene, std::move(chains)))
        report.propose(line_of(scene, scene.chains[chain]));

    if (!posture->is_upright)
        return report.warn("auto-rig: the spine does not go up from the legs as a human's, no limits proposed");
    std::vector<ProposedLimit> limits = propose_limits(scene, rest, found, posture->stance, report);
    fit_to_clips(scene, limits, report);
    for (const ProposedLimit& proposed : limits) {
        Joint& joint = scene.joints[proposed.joint];
        if (!joint.limits.empty() || (!claimed.empty() && claimed[proposed.joint])) continue;
        joint.limits.push_back(proposed.limit);
        report.propose(line_of(scene, proposed));
    }
}

}  // namespace bendy::converter
