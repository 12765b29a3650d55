#include "find_roles.h"

#include "body_details.h"
#include "clip_rotations.h"
#include "complete_human.h"
#include "find_body.h"
#include "find_characters.h"
#include "humanoid.h"
#include "mirrored_chains.h"
#include "scene/failure.h"
#include "scene/rest_frames.h"

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

constexpr std::array<std::array<Role, 2>, 2> kLegRoles{std::array{Role::left_front_leg, Role::right_front_leg},
                                                       std::array{Role::left_hind_leg, Role::right_hind_leg}};

/// The joints of a leg. Where joints of an IK rig move the paw, the first of them stands for the leg's end.
Joints joints_of_leg(const Scene& scene, const Animal& animal, std::size_t leg, const std::vector<bool>& moves) {
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

void add_animal(const Scene& scene, const RestFrames& rest, const Animal& animal, RoleList& roles) {
    const std::uint32_t hips =
        common_ancestor(scene, rest, {animal.legs[Animal::left_hind].front(), animal.legs[Animal::right_hind].front()});
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

void add_human(const Scene& scene, const Humanoid& human, RoleList& roles) {
    roles.add(human);
    roles.add_chain(Role::tail, find_tail(scene, {human[Role::hips], human[Role::spine]}));
    roles.add_chain(Role::left_wing, find_wing(scene, BodySide::left));
    roles.add_chain(Role::right_wing, find_wing(scene, BodySide::right));
}

std::vector<RoleRecord> roles_among(const Scene& scene, const ClipRotations& clips, const std::vector<bool>& among) {
    RoleList roles(scene);
    const FoundBody body = find_body(scene, clips, among);
    const RestFrames frames = body.frames(scene);
    if (body.whole_human) {
        add_human(scene, *body.whole_human, roles);
    } else if (!body.animal) {
        add_bird(scene, frames, body.human, roles);
    } else if (body.animal->legs.size() == kFourLegs) {
        add_animal(scene, frames, *body.animal, roles);
    }
    return roles.take();
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
        std::vector<RoleRecord> roles = roles_among(scene, clips, only_below(scene, all, root));
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
    std::vector<RoleRecord> whole = roles_among(scene, clips, std::vector<bool>(scene.joints.size(), true));
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
