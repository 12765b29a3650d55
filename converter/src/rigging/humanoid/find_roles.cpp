#include "find_roles.h"

#include "body_details.h"
#include "clip_rotations.h"
#include "find_body.h"
#include "find_characters.h"
#include "humanoid.h"
#include "mirrored_chains.h"
#include "scene/failure.h"
#include "scene/rest_frames.h"
#include "standing_pose.h"

#include <bendy/converter/report.h>
#include <bendy/format/records.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace bendy::converter {
namespace {

using Joints = std::vector<std::uint32_t>;

/// Collects roles: a joint has one, the first that it is given.
class RoleList {
public:
    explicit RoleList(const Scene& scene) : is_taken_(scene.joints.size()) {}

    void add(Role role, std::uint32_t joint, std::uint16_t place = 0) {
        if (joint == kNone || is_taken_[joint]) return;
        is_taken_[joint] = true;
        list_.push_back({joint, static_cast<std::uint16_t>(role), place});
    }
    void add_chain(Role role, const Joints& joints) {
        for (std::size_t place = 0; place < std::min<std::size_t>(joints.size(), 0xffff); ++place)
            add(role, joints[place], static_cast<std::uint16_t>(place));
    }
    void add(const Humanoid& bones) {
        for (auto role = static_cast<unsigned>(Role::hips); role < static_cast<unsigned>(kFirstChainRole); ++role)
            add(static_cast<Role>(role), bones[static_cast<Role>(role)]);
    }

    [[nodiscard]] std::vector<RoleRecord> take() {
        std::sort(list_.begin(), list_.end(),
                  [](const RoleRecord& a, const RoleRecord& b) { return a.joint < b.joint; });
        return std::move(list_);
    }

private:
    std::vector<bool> is_taken_;
    std::vector<RoleRecord> list_;
};

/// The joints from one below `top` down to `joint`, without `joint`.
Joints joints_between(const Scene& scene, std::uint32_t top, std::uint32_t joint) {
    Joints path;
    for (std::uint32_t at = scene.joints[joint].parent; at != kNone && at != top; at = scene.joints[at].parent)
        path.push_back(at);
    std::reverse(path.begin(), path.end());
    return path;
}

/// A human from the limbs and the head that were found; checks that they belong to one body.
class HumanRoles {
public:
    HumanRoles(const Scene& scene, const RestFrames& rest, const NamedHumanoid& found)
        : scene_(scene), rest_(rest), found_(found), bones_(found.bones) {}

    /// Nothing if this is not a human.
    std::optional<Humanoid> find() {
        if (!has_limbs() || !bones_.has(Role::head)) return std::nullopt;
        const std::optional<Posture> posture = measure_posture(rest_, found_);
        if (!posture || !posture->is_upright || !posture->has_feet_forward) return std::nullopt;
        for (const Limb limb : {Limb::left_arm, Limb::right_arm, Limb::left_leg, Limb::right_leg}) add_end(limb);
        if (!find_hips() || !find_trunk()) return std::nullopt;
        add_details(scene_, rest_, bones_);
        return bones_;
    }

private:
    [[nodiscard]] bool is_named(std::uint32_t joint, BodyPart part) const {
        const std::optional<BoneName> name = read_bone_name(scene_.joints[joint].name);
        return name && name->part == part;
    }
    [[nodiscard]] bool is_wing(Role arm) const { return NameWords(scene_.joints[bones_[arm]].name).has("wing"); }

    [[nodiscard]] bool has_limbs() const {
        for (const Limb limb : {Limb::left_arm, Limb::right_arm, Limb::left_leg, Limb::right_leg}) {
            const LimbBones of_limb = bones_of(limb);
            if (!bones_.has(of_limb.upper) || !bones_.has(of_limb.lower)) return false;
            if (is_wing(of_limb.upper) || is_wing(of_limb.lower)) return false;
            if (!rest_.is_below(bones_[of_limb.lower], bones_[of_limb.upper])) return false;
            if (!rest_.direction(bones_[of_limb.upper], bones_[of_limb.lower])) return false;
        }
        return true;
    }

    /// A foot that its own rig moves, at the end of the leg; of a hand that branches from the forearm, the middle.
    void add_end(Limb limb) {
        const LimbBones of_limb = bones_of(limb);
        const std::uint32_t loose = found_.loose_ends[static_cast<std::size_t>(limb)];
        const std::optional<glm::dvec3> end = end_of(found_, rest_, limb);
        const bool is_arm = limb == Limb::left_arm || limb == Limb::right_arm;
        if (is_arm && found_.has_split_hands)
            bones_[of_limb.end] = find_split_hand(scene_, rest_, bones_[of_limb.lower]);
        if (!bones_.has(of_limb.end) && loose != kNone && end && *end == rest_.position(loose))
            bones_[of_limb.end] = loose;
    }

    /// The joint named as the hips, if it carries the legs and the head; else the lowest joint that does, or the one
    /// named as the hips if it carries the head. False if none of them is near the legs, as a root on the ground is
    /// not.
    bool find_hips() {
        const Joints body{bones_[Role::left_upper_leg], bones_[Role::right_upper_leg], bones_[Role::head]};
        const glm::dvec3 between = 0.5 * (rest_.position(body[0]) + rest_.position(body[1]));
        const double thigh = glm::distance(rest_.position(body[0]), rest_.position(bones_[Role::left_lower_leg]));
        const auto is_near = [&](std::uint32_t joint) {
            return joint != kNone && rest_.is_below(body[2], joint) &&
                   glm::distance(rest_.position(joint), between) < 1.5 * thigh;
        };
        const auto carries_all = [&](std::uint32_t joint) {
            return std::all_of(body.begin(), body.end(),
                               [&](std::uint32_t each) { return rest_.is_below(each, joint); });
        };
        const std::uint32_t named = bones_[Role::hips];
        if (is_near(named) && carries_all(named)) return true;
        const std::uint32_t lowest = common_ancestor(scene_, rest_, body);
        bones_[Role::hips] = is_near(lowest) ? lowest : named;
        return is_near(bones_[Role::hips]);
    }

    /// Names the joints from the hips to the head. False if the arms do not leave from there.
    bool find_trunk() {
        Joints path = joints_between(scene_, bones_[Role::hips], bones_[Role::head]);
        const std::uint32_t arms =
            common_ancestor(scene_, rest_, {bones_[Role::left_upper_arm], bones_[Role::right_upper_arm]});
        const auto chest = std::find(path.begin(), path.end(), arms);
        if (arms != bones_[Role::hips] && chest == path.end()) return false;
        auto neck = std::find(path.begin(), path.end(), bones_[Role::neck]);
        if (neck == path.end()) neck = chest == path.end() ? path.begin() : chest + 1;
        bones_[Role::neck] = neck == path.end() ? kNone : *neck;
        path.erase(neck, path.end());
        // Some rigs have a joint `Hips` above the legs' joint, which carries the spine alone.
        std::erase_if(path, [&](std::uint32_t joint) { return is_named(joint, BodyPart::hips); });
        bones_[Role::spine] = path.empty() ? kNone : path.front();
        bones_[Role::chest] = path.size() < 2 ? kNone : path[path.size() / 2];
        bones_[Role::upper_chest] = path.size() < 3 ? kNone : path.back();
        return true;
    }

    const Scene& scene_;
    const RestFrames& rest_;
    const NamedHumanoid& found_;
    Humanoid bones_;
};

constexpr std::array<std::array<Role, 2>, 2> kLegRoles{std::array{Role::left_front_leg, Role::right_front_leg},
                                                       std::array{Role::left_hind_leg, Role::right_hind_leg}};

/// The joints of a leg. Where joints of an IK rig move the paw, the first of them stands for the leg's end.
Joints joints_of_leg(const Scene& scene, const Quadruped& animal, std::size_t leg, const std::vector<bool>& moves) {
    Joints joints = animal.legs[leg];
    const std::uint32_t target = animal.targets[leg];
    if (target != kNone && moves[target] && !moves[joints.back()]) {
        joints.back() = target;
        for (std::uint32_t joint = target + 1; joint < scene.joints.size(); ++joint) {
            if (scene.joints[joint].parent == joints.back() && moves[joint]) joints.push_back(joint);
        }
    } else {
        joints.insert(joints.end(), animal.paws[leg].begin(), animal.paws[leg].end());
    }
    return joints;
}

void add_animal(const Scene& scene, const RestFrames& rest, const Quadruped& animal, RoleList& roles) {
    const std::uint32_t hips = common_ancestor(
        scene, rest, {animal.legs[Quadruped::left_hind].front(), animal.legs[Quadruped::right_hind].front()});
    const std::vector<bool> moves = find_moving_joints(scene);
    for (std::size_t leg = 0; leg < animal.legs.size(); ++leg)
        roles.add_chain(kLegRoles[leg / 2][leg % 2], joints_of_leg(scene, animal, leg, moves));
    Joints neck = animal.neck;
    if (!neck.empty()) roles.add(Role::head, neck.back());
    if (!neck.empty()) neck.pop_back();
    roles.add(Role::hips, hips);
    roles.add_chain(Role::spine_chain, animal.spine);
    roles.add_chain(Role::neck_chain, neck);
    roles.add_chain(Role::tail, animal.tail);
}

/// A bird: two legs and a head by name, and joints named as wings.
void add_bird(const Scene& scene, const RestFrames& rest, const NamedHumanoid& named, RoleList& roles) {
    const Humanoid& bones = named.bones;
    const Joints left = find_wing(scene, BodySide::left);
    const Joints right = find_wing(scene, BodySide::right);
    const bool has_legs = bones.has(Role::left_foot) && bones.has(Role::right_foot);
    if (left.empty() || left.size() != right.size() || !has_legs || !bones.has(Role::head)) return;
    const std::uint32_t hips =
        common_ancestor(scene, rest, {bones[Role::left_upper_leg], bones[Role::right_upper_leg], bones[Role::head]});
    if (hips == kNone) return;
    const Joints path = joints_between(scene, hips, bones[Role::head]);
    const auto neck = std::find(path.begin(), path.end(), bones[Role::neck]);
    const auto leg = [&](Role upper, Role foot, Role toes) {
        const std::uint32_t last = bones.has(toes) ? bones[toes] : bones[foot];
        if (!bones.has(upper) || !rest.is_below(last, bones[upper])) return Joints{};
        Joints joints = joints_between(scene, bones[upper], last);
        joints.insert(joints.begin(), bones[upper]);
        joints.push_back(last);
        return joints;
    };
    roles.add(Role::hips, hips);
    roles.add(Role::head, bones[Role::head]);
    roles.add_chain(Role::spine_chain, Joints(path.begin(), neck));
    roles.add_chain(Role::neck_chain, Joints(neck, path.end()));
    roles.add_chain(Role::left_hind_leg, leg(Role::left_upper_leg, Role::left_foot, Role::left_toes));
    roles.add_chain(Role::right_hind_leg, leg(Role::right_upper_leg, Role::right_foot, Role::right_toes));
    roles.add_chain(Role::left_wing, left);
    roles.add_chain(Role::right_wing, right);
}

void add_human(const Scene& scene, const RestFrames& rest, const NamedHumanoid& found, RoleList& roles) {
    const std::optional<Humanoid> human = HumanRoles(scene, rest, found).find();
    if (!human) return add_bird(scene, rest, found, roles);
    roles.add(*human);
    roles.add_chain(Role::tail, find_tail(scene, {(*human)[Role::hips], (*human)[Role::spine]}));
    roles.add_chain(Role::left_wing, find_wing(scene, BodySide::left));
    roles.add_chain(Role::right_wing, find_wing(scene, BodySide::right));
}

std::vector<RoleRecord> roles_among(const Scene& scene, const RestFrames& rest, const ClipRotations& clips,
                                    const std::vector<bool>& among) {
    RoleList roles(scene);
    const FoundBody body = find_body(scene, rest, clips, among);
    if (body.animal) {
        add_animal(scene, rest, *body.animal, roles);
    } else {
        add_human(scene, rest, body.human, roles);
    }
    return roles.take();
}

/// The roles of a body whose names are clear, but whose rest pose does not have its shape: in the pose of its bind
/// matrices, or in the frame of a clip in which it stands best.
std::vector<RoleRecord> roles_in_another_pose(const Scene& scene, const RestFrames& rest, const ClipRotations& clips) {
    const std::vector<bool> all(scene.joints.size(), true);
    const NamedHumanoid named = find_humanoid(scene, rest, find_bound_joints(scene));
    const auto roles_in = [&](const std::optional<CandidatePose>& pose) {
        return pose ? roles_among(scene, RestFrames(scene, pose->locals), clips, all) : std::vector<RoleRecord>();
    };
    std::vector<RoleRecord> roles = roles_in(find_bind_pose(scene));
    if (roles.empty()) roles = roles_in(find_standing_frame(scene, named.bones, find_up(scene, named.bones)));
    return roles;
}

bool has_role(const std::vector<RoleRecord>& roles, std::uint32_t joint) {
    return std::any_of(roles.begin(), roles.end(), [&](const RoleRecord& each) { return each.joint == joint; });
}

/// kNone if nobody has the role.
std::uint32_t joint_with(const std::vector<RoleRecord>& roles, Role role) {
    const auto found = std::find_if(roles.begin(), roles.end(), [&](const RoleRecord& each) {
        return each.role == static_cast<std::uint16_t>(role);
    });
    return found == roles.end() ? kNone : found->joint;
}

struct Character {
    std::uint32_t root = 0;
    std::vector<RoleRecord> roles;
};

/// The characters of a scene that has several; otherwise nothing.
/// \param whole  the roles that are found among all joints
std::vector<Character> find_several(const Scene& scene, const RestFrames& rest, const ClipRotations& clips,
                                    const std::vector<RoleRecord>& whole) {
    constexpr std::size_t kMost = 8;
    std::vector<std::uint32_t> branches = find_branches(scene, find_bound_joints(scene));
    if (branches.size() > kMost) branches.resize(kMost);
    const std::uint32_t hips = joint_with(whole, Role::hips);
    const bool divides_one = hips != kNone && std::none_of(branches.begin(), branches.end(), [&](std::uint32_t root) {
                                 return hips == root || rest.is_below(hips, root);
                             });
    if (branches.size() < 2 || divides_one) return {};
    std::vector<Character> found;
    for (const std::uint32_t root : branches) {
        const std::vector<bool> all(scene.joints.size(), true);
        std::vector<RoleRecord> roles = roles_among(scene, rest, clips, only_below(scene, all, root));
        // Without a body that is known, a hand may look like an animal.
        const bool counts = hips != kNone ? !roles.empty() : joint_with(roles, Role::left_upper_leg) != kNone;
        if (counts) found.push_back({root, std::move(roles)});
    }
    return found.size() < 2 ? std::vector<Character>() : found;
}

void warn_of_others(const Scene& scene, const std::vector<Character>& all, const Character& used, Report& report) {
    const auto shown = [&](std::uint32_t joint) {
        return quote(scene.joints[joint].name) + " (#" + std::to_string(joint) + ')';
    };
    std::string names;
    for (std::size_t k = 0; k < all.size(); ++k)
        names += (k == 0 ? "" : k + 1 < all.size() ? ", " : " and ") + shown(all[k].root);
    const Character& other = all[all.front().root == used.root ? 1 : 0];
    report.warn(
        "there are " + std::to_string(all.size()) + " characters, below the joints " + names +
        ": the roles are those of " + shown(used.root) +
        ". To give them to another one, name its hips in a rig file (--rig), as in {\"bendy_rig\": 1, \"roles\": "
        "{\"hips\": \"#" +
        std::to_string(joint_with(other.roles, Role::hips)) + "\"}}");
}

}  // namespace

void find_roles(Scene& scene, std::uint32_t hips, Report& report) {
    if (scene.joints.empty() || (!scene.roles.empty() && (hips == kNone || has_role(scene.roles, hips)))) return;
    Report unheard;  // discarded: reported when the extension's chains are made
    if (scene.roles.empty()) {
        if (const std::optional<VrmHumanoid> vrm = read_vrm_humanoid(scene, unheard)) {
            RoleList roles(scene);
            roles.add(vrm->bones);
            scene.roles = roles.take();
            return;
        }
    }
    const RestFrames rest(scene);
    const ClipRotations clips(scene);
    std::vector<RoleRecord> whole = roles_among(scene, rest, clips, std::vector<bool>(scene.joints.size(), true));
    if (whole.empty()) whole = roles_in_another_pose(scene, rest, clips);
    std::vector<Character> all = find_several(scene, rest, clips, whole);
    const std::uint32_t wanted = hips == kNone ? joint_with(whole, Role::hips) : hips;
    const auto used = std::find_if(all.begin(), all.end(), [&](const Character& each) {
        return wanted == kNone || wanted == each.root || rest.is_below(wanted, each.root);
    });
    if (used == all.end()) {
        if (scene.roles.empty()) scene.roles = std::move(whole);
        return;
    }
    if (hips == kNone) warn_of_others(scene, all, *used, report);
    scene.roles = std::move(used->roles);
}

}  // namespace bendy::converter
