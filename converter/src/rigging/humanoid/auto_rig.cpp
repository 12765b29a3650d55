#include "auto_rig.h"

#include "anatomy.h"
#include "animal.h"
#include "clip_rotations.h"
#include "find_body.h"
#include "find_humanoid.h"
#include "humanoid.h"
#include "limb_chains.h"
#include "posture.h"
#include "scene/failure.h"
#include "scene/rest_frames.h"

#include <bendy/format/names.h>
#include <bendy/format/trig.h>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

namespace bendy::converter {
namespace {

/// The direction of a limb's middle joint, and how many clips support it; 0: taken from the rest pose, or a human's.
struct ProposedBend {
    glm::dvec3 way{0.0};  ///< in model space at rest
    std::uint32_t clips = 0;
};

/// Radians as whole degrees.
std::string degrees(float radians) {
    const double exact = static_cast<double>(radians) * 180.0 / trig::kPi;
    return std::to_string(std::lround(exact + (exact < 0.0 ? -1e-4 : 1e-4)));  // half degrees round outward
}

std::string range_of(const ConstraintRecord& constraint, std::size_t axis) {
    return degrees(constraint.rotation_min[axis]) + " to " + degrees(constraint.rotation_max[axis]);
}

/// Formats with a fixed number of decimals, independent of the locale.
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

std::string part_of(const JointAnatomy& anatomy) {
    constexpr std::array<const char*, 15> kWords{
        "collarbone", "shoulder",  "elbow",    "wrist",           "hip",
        "knee",       "ankle",     "toes",     "spine",           "neck",
        "tail",       "front leg", "hind leg", "front leg joint", "hind leg joint"};
    std::string words = kWords.at(static_cast<std::size_t>(anatomy.part));
    const bool is_in_middle =
        anatomy.part == BodyJoint::spine || anatomy.part == BodyJoint::neck || anatomy.part == BodyJoint::tail;
    if (!is_in_middle) words.insert(0, anatomy.is_right ? "right " : "left ");
    return anatomy.number == 0 ? words : words + ' ' + std::to_string(anatomy.number);
}

std::string way_of(const glm::dvec3& way, const Stance& stance) {
    std::array<std::pair<double, const char*>, 6> ways{{{glm::dot(way, stance.forward), "forward"},
                                                        {-glm::dot(way, stance.forward), "backward"},
                                                        {glm::dot(way, stance.up), "up"},
                                                        {-glm::dot(way, stance.up), "down"},
                                                        {glm::dot(way, stance.left), "left"},
                                                        {-glm::dot(way, stance.left), "right"}}};
    std::stable_sort(ways.begin(), ways.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    std::string words = ways[0].second;
    if (ways[1].first > 0.5) words += std::string(" and ") + ways[1].second;
    return words;
}

/// The joint's name, or its number if it has none.
std::string name_of(const Scene& scene, std::uint32_t joint) {
    const std::string& name = scene.joints[joint].name;
    return name.empty() ? '#' + std::to_string(joint) : name;
}

Proposal proposal_of(const Scene& scene, const Chain& chain, const std::optional<ProposedBend>& bend,
                     const Stance& stance) {
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
    line.append(", ").append(kValueNames<Solver>.at(chain.record.solver));
    if (bend) {
        const bool is_arm = chain.name.find("Arm") != std::string::npos;
        line += std::string(is_arm ? ", elbow" : ", knee") + " points " + way_of(bend->way, stance);
        if (bend->clips != 0) line += " as in " + counted(bend->clips, "clip");
    }
    return {Proposal::Kind::chain, chain.name, std::move(line)};
}

/// \param whose  owner of the typical ranges, as `a human's`
Proposal proposal_of(const Scene& scene, const ProposedConstraint& proposed, const std::string& whose) {
    const ConstraintRecord& constraint = proposed.constraint;
    std::string name = name_of(scene, proposed.anatomy.joint);
    std::string line = part_of(proposed.anatomy) + ", " + name + ": ";
    const auto model = static_cast<ConstraintModel>(constraint.model);
    if (model == ConstraintModel::hinge) {
        line += "hinge about " + vector_of(proposed.axis) + ", " + range_of(constraint, 0) + " degrees";
    } else if (bends(proposed.anatomy.part)) {
        line += "bends " + range_of(constraint, 2) + " degrees about " + vector_of(proposed.axis) + ", sideways " +
                range_of(constraint, 1) + ", twist " + range_of(constraint, 0);
    } else {
        line += "swing " + range_of(constraint, 1) + " and " + range_of(constraint, 2) + " degrees, twist " +
                range_of(constraint, 0);
    }
    if (const long straight = std::lround(proposed.straight); straight != 0)
        line += ", straight at " + std::to_string(straight);
    if (proposed.is_axis_fitted) {
        line += ", axis fitted to " + counted(proposed.clips, "clip") + ", " + decimals(proposed.axis_off, 1) +
                " degrees off " + whose;
    }
    if (proposed.growth > 0.05 && proposed.clips > 0) {
        line += ", up to " + std::to_string(std::lround(std::ceil(proposed.growth))) + " degrees wider than " + whose +
                " for " + counted(proposed.clips, "clip");
    }
    return {Proposal::Kind::limits, std::move(name), std::move(line)};
}

constexpr std::array<const char*, kLimbs> kChainNames{"LeftArm", "RightArm", "LeftLeg", "RightLeg"};

/// Makes chains for limbs without a joint at the end. If a hand or foot is moved by its own rig, that joint's rest
/// position is the tip, and the joint the target; otherwise the tip is where the mesh ends.
std::vector<Chain> make_loose_chains(const Scene& scene, const RestFrames& rest, const NamedHumanoid& found,
                                     const Stance& stance) {
    std::vector<Chain> chains;
    for (std::size_t i = 0; i < kLimbs; ++i) {
        const LimbBones bones = bones_of(static_cast<Limb>(i));
        const std::optional<glm::dvec3> end = end_of(found, rest, static_cast<Limb>(i));
        if (found.bones.has(bones.end) || !found.bones.has(bones.upper) || !found.bones.has(bones.lower) || !end)
            continue;
        const std::uint32_t upper = found.bones[bones.upper];
        const std::uint32_t lower = found.bones[bones.lower];
        const auto tip = rest.point_in_space_of(lower, *end);
        if (!tip) continue;
        Chain chain;
        chain.name = kChainNames[i];
        chain.record.start = upper;
        chain.record.effector = lower;
        if (found.loose_ends[i] != kNone && *end == rest.position(found.loose_ends[i]))
            chain.record.target = found.loose_ends[i];
        chain.record.solver = static_cast<std::uint8_t>(Solver::two_bone);
        chain.record.flags = kProposed;
        chain.record.tip_offset = {static_cast<float>(tip->x), static_cast<float>(tip->y), static_cast<float>(tip->z)};
        std::optional<glm::dvec3> bend = bend_of(rest, upper, lower, *end);
        const auto along = unit(*end - rest.position(upper));
        if (!bend && along) bend = unit_across(i < 2 ? -stance.forward : stance.forward, *along);
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

/// The directions in which the limbs' middle joints point.
class Bends {
public:
    Bends(const Scene& scene, const RestFrames& rest, const ClipRotations& clips, const NamedHumanoid& found,
          const Stance& stance)
        : scene_(scene), rest_(rest) {
        for (std::size_t limb = 0; limb < kLimbs; ++limb) bends_[limb] = measure(clips, found, limb);
        for (const std::size_t left : {0u, 2u}) {
            // Makes both sides alike: the mean of one and the other's mirror image, if they roughly agree.
            std::optional<ProposedBend>& a = bends_[left];
            std::optional<ProposedBend>& b = bends_[left + 1];
            const auto mirror = [&](const glm::dvec3& v) { return v - 2.0 * glm::dot(v, stance.left) * stance.left; };
            if (a && !b) b = ProposedBend{mirror(a->way), a->clips};
            if (b && !a) a = ProposedBend{mirror(b->way), b->clips};
            if (!a || !b || glm::dot(mirror(a->way), b->way) < 0.5) continue;
            const auto mean = unit(a->way + mirror(b->way));
            if (!mean) continue;
            a->way = *mean;
            b->way = mirror(*mean);
        }
    }

    /// Sets the pole to the direction in which the clips bend the limb, if there is one.
    void turn_pole(Chain& chain) const {
        const std::optional<ProposedBend> bend = of(chain);
        if (!bend || bend->clips == 0) return;
        const auto pole = rest_.to_space_of(scene_.joints[chain.record.start].parent, bend->way);
        if (!pole) return;
        chain.record.pole_vector = {static_cast<float>(pole->x), static_cast<float>(pole->y),
                                    static_cast<float>(pole->z)};
    }

    /// The bend of a limb's chain; nothing for other chains.
    [[nodiscard]] std::optional<ProposedBend> of(const Chain& chain) const {
        const auto* const name = std::find(kChainNames.begin(), kChainNames.end(), chain.name);
        if (name == kChainNames.end()) return std::nullopt;
        const auto& bend = bends_[static_cast<std::size_t>(name - kChainNames.begin())];
        if (bend) return bend;
        const auto& pole = chain.record.pole_vector;
        const std::uint32_t parent = scene_.joints[chain.record.start].parent;
        const glm::dvec3 way(pole[0], pole[1], pole[2]);
        if (way == glm::dvec3(0.0)) return std::nullopt;
        return ProposedBend{parent == kNone ? way : rest_.turn(parent) * way, 0};
    }

private:
    [[nodiscard]] std::optional<ProposedBend> measure(const ClipRotations& clips, const NamedHumanoid& found,
                                                      std::size_t limb) const {
        constexpr double kClearly = 0.4;  // minimum agreement of the clips
        const LimbBones bones = bones_of(static_cast<Limb>(limb));
        if (!found.bones.has(bones.upper) || !found.bones.has(bones.lower)) return std::nullopt;
        ClipRotations::Limb two_bones{found.bones[bones.upper], found.bones[bones.lower], found.bones[bones.end]};
        if (two_bones.end == kNone) {
            const auto end = end_of(found, rest_, static_cast<Limb>(limb));
            const auto tip = end ? rest_.point_in_space_of(two_bones.middle, *end) : std::nullopt;
            if (!tip) return std::nullopt;
            two_bones.end = two_bones.middle;
            two_bones.tip = *tip;
        }
        const std::optional<ClipRotations::Bend> bend = clips.bend_of(two_bones);
        const std::uint32_t parent = scene_.joints[two_bones.start].parent;
        if (!bend || bend->agreement < kClearly) return std::nullopt;
        return ProposedBend{parent == kNone ? bend->direction : rest_.turn(parent) * bend->direction, bend->clips};
    }

    const Scene& scene_;
    const RestFrames& rest_;
    std::array<std::optional<ProposedBend>, kLimbs> bends_;
};

constexpr double kFarthestBeyond = 30.0;  // degrees; a limit that clips leave by more is not proposed

/// Says which clip turns the joint beyond its proposed limit, and how far.
std::string beyond_of(const Scene& scene, const ProposedConstraint& proposed) {
    if (!proposed.farthest_clip) return "";
    return "clip " + quote(scene.clips[*proposed.farthest_clip].name) + " turns the joint by " +
           std::to_string(std::lround(proposed.beyond)) + " degrees more than such a joint can turn";
}

/// Adds limits for joints that have none, and that their clips do not leave by far.
/// \param whose  see proposal_of
void add_limits(Scene& scene, const RestFrames& rest, const ClipRotations& clips,
                const std::vector<JointAnatomy>& anatomy, const glm::dvec3& left, const std::string& whose,
                const std::vector<bool>& claimed, Report& report) {
    for (const ProposedConstraint& proposed : fit_to_clips(scene, rest, clips, anatomy, left, report)) {
        Joint& joint = scene.joints[proposed.anatomy.joint];
        if (!joint.constraints.empty() || (!claimed.empty() && claimed[proposed.anatomy.joint])) continue;
        const std::string place = name_of(scene, proposed.anatomy.joint);
        const std::string turned = beyond_of(scene, proposed);
        if (proposed.beyond > kFarthestBeyond) {
            report.warn("auto-rig: no limit proposed, since " + turned, place);
            continue;
        }
        joint.constraints.push_back(proposed.constraint);
        report.propose(proposal_of(scene, proposed, whose));
        if (proposed.beyond > 0.5) report.warn("auto-rig: " + turned + ", and leaves its proposed limit", place);
    }
}

/// The joint of a human below which a joint is to hang, so that a limit about its parent is one about the body.
std::uint32_t carrier_of(const Humanoid& bones, const JointAnatomy& one) {
    const auto bone = [&](HumanBone left) { return bones[one.is_right ? mirrored(left) : left]; };
    switch (one.part) {
        case BodyJoint::knee:
            return bone(HumanBone::left_upper_leg);
        case BodyJoint::ankle:
            return bone(HumanBone::left_lower_leg);
        case BodyJoint::toes:
            return bone(HumanBone::left_foot);
        case BodyJoint::elbow:
            return bone(HumanBone::left_upper_arm);
        case BodyJoint::wrist:
            return bone(HumanBone::left_lower_arm);
        case BodyJoint::hip:
        case BodyJoint::spine:
            return bones[HumanBone::hips];
        default:
            return bones.has(HumanBone::spine) ? bones[HumanBone::spine] : bones[HumanBone::hips];
    }
}

/// Takes out the joints that hang on a control beside the body, which does not turn with it.
void leave_out_loose(const Scene& scene, const RestFrames& rest, const Humanoid& bones,
                     std::vector<JointAnatomy>& anatomy, Report& report) {
    std::erase_if(anatomy, [&](const JointAnatomy& one) {
        const std::uint32_t carrier = carrier_of(bones, one);
        if (carrier == kNone || one.joint == carrier || rest.is_below(one.joint, carrier)) return false;
        report.warn(
            "auto-rig: no limit proposed, since the joint hangs beside " + name_of(scene, carrier) + ", not below it",
            name_of(scene, one.joint));
        return true;
    });
}

/// The animal's axes where they are at rest, if it was found in another pose.
Stance at_rest(const RestFrames& rest, const RestFrames& pose, const Animal& animal) {
    const std::uint32_t joint = animal.legs.front().front();
    const glm::dquat turn = rest.turn(joint) * glm::conjugate(pose.turn(joint));
    return {turn * animal.stance.left, turn * animal.stance.up, turn * animal.stance.forward};
}

/// Bodies of more than four legs get chains, but no limits: nobody says what theirs are.
void rig_animal(Scene& scene, const RestFrames& rest, const ClipRotations& clips, const FoundBody& body,
                const std::vector<bool>& claimed, Report& report) {
    Animal animal = *body.animal;
    const RestFrames pose = body.frames(scene);
    for (const std::size_t chain : add_new_chains(scene, make_animal_chains(scene, pose, animal, kProposed)))
        report.propose(proposal_of(scene, scene.chains[chain], std::nullopt, animal.stance));
    if (animal.legs.size() != kFourLegs) return;
    if (!body.pose.empty()) animal.stance = at_rest(rest, pose, animal);
    add_limits(scene, rest, clips, find_anatomy(rest, animal), animal.stance.left, "an animal's", claimed, report);
}

/// Chains are as in the pose in which the body was found, limits about the rest pose.
void rig_human(Scene& scene, const RestFrames& rest, const ClipRotations& clips, const FoundBody& body,
               const std::vector<bool>& claimed, Report& report) {
    const NamedHumanoid& found = body.human;
    const RestFrames pose = body.frames(scene);
    const std::optional<Posture> posture = measure_posture(pose, found);
    if (!posture) {
        return report.warn(
            "auto-rig: neither the joints' names nor the skeleton's shape say where the limbs of a human or of an "
            "animal on four legs are, nothing proposed");
    }
    const Stance& stance = posture->stance;
    if (!posture->has_feet_forward)
        return report.warn("auto-rig: the feet point backward from what left and right say, nothing proposed");
    if (found.contradicts_names) {
        report.warn(
            "auto-rig: left and right in the joints' names contradict the way that feet and knees point, left and "
            "right below are the character's own");
    }
    Report unheard;  // discarded: warnings about missing limbs
    std::vector<Chain> chains = make_limb_chains(scene, pose, found.bones, stance, kProposed, {}, unheard);
    for (Chain& chain : make_loose_chains(scene, pose, found, stance)) chains.push_back(std::move(chain));
    const Bends bends(scene, pose, clips, found, stance);
    for (Chain& chain : chains) bends.turn_pole(chain);
    for (const std::size_t chain : add_new_chains(scene, std::move(chains)))
        report.propose(proposal_of(scene, scene.chains[chain], bends.of(scene.chains[chain]), stance));
    if (found.has_front_legs) return report.warn("auto-rig: front legs are not a human's arms, no limits proposed");
    if (!posture->is_upright)
        return report.warn("auto-rig: the spine does not go up from the legs as a human's, no limits proposed");
    const std::optional<Posture> resting = measure_posture(rest, found);
    if (!resting || !resting->is_upright || !resting->has_feet_forward)
        return report.warn("auto-rig: limits are about the rest pose, which is not that of a body here, none proposed");
    std::vector<JointAnatomy> anatomy = find_anatomy(scene, rest, found, resting->stance);
    leave_out_loose(scene, rest, found.bones, anatomy, report);
    add_limits(scene, rest, clips, anatomy, resting->stance.left, "a human's", claimed, report);
}

}  // namespace

void auto_rig(Scene& scene, const std::vector<bool>& claimed, Report& report) {
    const RestFrames rest(scene);
    const ClipRotations clips(scene);
    Report unheard;  // discarded: reported when the extension's own chains were made
    if (const std::optional<VrmHumanoid> vrm = read_vrm_humanoid(scene, unheard)) {
        FoundBody body;
        body.human.bones = vrm->bones;
        return rig_human(scene, rest, clips, body, claimed, report);
    }
    const FoundBody body = find_body(scene, clips, std::vector<bool>(scene.joints.size(), true));
    if (body.animal) return rig_animal(scene, rest, clips, body, claimed, report);
    rig_human(scene, rest, clips, body, claimed, report);
}

void add_vrm_chains(Scene& scene, Report& report) {
    const std::optional<VrmHumanoid> vrm = read_vrm_humanoid(scene, report);
    if (!vrm) return;
    Stance stance;
    if (vrm->faces_backward) {
        stance.left = -stance.left;
        stance.forward = -stance.forward;
    }
    const RestFrames rest(scene);
    add_new_chains(scene, make_limb_chains(scene, rest, vrm->bones, stance, 0, vrm->place, report));
}

}  // namespace bendy::converter
