#include "complete_human.h"

#include "body_details.h"
#include "mirrored_chains.h"
#include "posture.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstddef>

namespace bendy::converter {
namespace {

/// A human from the limbs and the head that were found; checks that they belong to one body.
class HumanCompleter {
public:
    HumanCompleter(const Scene& scene, const RestFrames& rest, const NamedHumanoid& found)
        : scene_(scene), rest_(rest), found_(found), bones_(found.bones) {}

    /// Nothing if this is not a human.
    std::optional<Humanoid> find() {
        if (!has_limbs() || !bones_.has(Role::head) || found_.has_front_legs) return std::nullopt;
        const std::optional<Posture> posture = measure_posture(rest_, found_);
        if (!posture || !posture->is_upright || !posture->has_feet_forward) return std::nullopt;
        for (const Limb limb : {Limb::left_arm, Limb::right_arm, Limb::left_leg, Limb::right_leg}) {
            if (bones_.has(bones_of(limb).lower)) add_end(limb);
        }
        if (!find_hips() || !find_trunk()) return std::nullopt;
        if (is_block(Limb::left_arm)) drop_arms();
        add_details(scene_, rest_, bones_);
        return bones_;
    }

private:
    [[nodiscard]] bool is_named(std::uint32_t joint, BodyPart part) const {
        const std::optional<BoneName> name = read_bone_name(scene_.joints[joint].name);
        return name && name->part == part;
    }
    [[nodiscard]] bool is_wing(Role arm) const { return NameWords(scene_.joints[bones_[arm]].name).has("wing"); }

    /// Whether neither the limb nor its counterpart has a second bone.
    [[nodiscard]] bool is_block(Limb limb) const {
        const bool is_arm = limb == Limb::left_arm || limb == Limb::right_arm;
        const HumanBone lower = is_arm ? HumanBone::left_lower_arm : HumanBone::left_lower_leg;
        return !bones_.has(lower) && !bones_.has(mirrored(lower));
    }
    /// Joints alone do not say where arms of one joint point, and clips of others would turn them from anywhere; such
    /// legs point down.
    void drop_arms() { bones_[Role::left_upper_arm] = bones_[Role::right_upper_arm] = kNone; }
    [[nodiscard]] bool has_arms() const { return bones_.has(Role::left_upper_arm); }

    /// A robot may lack both arms, but a body with one arm, or with two legs and wings, is not a human. Limbs of a toy
    /// have one joint; its legs show by their mesh that it stands on them.
    [[nodiscard]] bool has_limbs() const {
        bool has_any_arm = false;
        for (const Role bone :
             {Role::left_upper_arm, Role::left_lower_arm, Role::right_upper_arm, Role::right_lower_arm})
            has_any_arm = has_any_arm || bones_.has(bone);
        if (!has_any_arm && (is_block(Limb::left_leg) || !find_wing(scene_, BodySide::left).empty())) return false;
        for (const Limb limb : {Limb::left_arm, Limb::right_arm, Limb::left_leg, Limb::right_leg}) {
            if (!has_any_arm && (limb == Limb::left_arm || limb == Limb::right_arm)) continue;
            const LimbBones of_limb = bones_of(limb);
            if (!bones_.has(of_limb.upper) || is_wing(of_limb.upper)) return false;
            if (is_block(limb)) {
                const bool is_leg = limb == Limb::left_leg || limb == Limb::right_leg;
                if (is_leg && !end_of(found_, rest_, limb)) return false;
                continue;
            }
            if (!bones_.has(of_limb.lower) || is_wing(of_limb.lower)) return false;
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
        if (is_arm && found_.has_split_hands) {
            const std::uint32_t branch = find_split_hand(scene_, rest_, bones_[of_limb.lower]);
            const bool is_palm = branch != kNone && !is_finger(scene_.joints[branch].name);
            bones_[of_limb.end] = is_palm ? branch : kNone;
        }
        if (!bones_.has(of_limb.end) && loose != kNone && end && *end == rest_.position(loose))
            bones_[of_limb.end] = loose;
    }

    /// The joint named as the hips, if it carries the legs and the head; else the lowest joint that does, or the one
    /// named as the hips if it carries the head; where the spine hangs beside the pelvis, what carries the legs. False
    /// if none of them is near the legs, as a root on the ground is not.
    bool find_hips() {
        const std::vector<std::uint32_t> legs{bones_[Role::left_upper_leg], bones_[Role::right_upper_leg]};
        const std::uint32_t head = bones_[Role::head];
        const glm::dvec3 between = 0.5 * (rest_.position(legs[0]) + rest_.position(legs[1]));
        const double thigh = is_block(Limb::left_leg)
                                 ? 0.5 * glm::distance(rest_.position(legs[0]), *end_of(found_, rest_, Limb::left_leg))
                                 : glm::distance(rest_.position(legs[0]), rest_.position(bones_[Role::left_lower_leg]));
        const auto is_near = [&](std::uint32_t joint) {
            return joint != kNone && glm::distance(rest_.position(joint), between) < 1.5 * thigh;
        };
        const auto carries_legs = [&](std::uint32_t joint) {
            return rest_.is_below(legs[0], joint) && rest_.is_below(legs[1], joint);
        };
        const std::uint32_t named = bones_[Role::hips];
        const std::uint32_t lowest = common_ancestor(scene_, rest_, {legs[0], legs[1], head});
        const std::uint32_t of_legs = common_ancestor(scene_, rest_, legs);
        const bool carries_head = is_near(named) && rest_.is_below(head, named);
        if (carries_head && carries_legs(named)) return true;
        if (is_near(lowest)) {
            bones_[Role::hips] = lowest;
        } else if (!carries_head) {
            bones_[Role::hips] = is_near(named) && carries_legs(named) ? named : of_legs;
        }
        return is_near(bones_[Role::hips]);
    }

    /// The joints of spine and neck, below the hips or, in rigs whose parts hang on controls, beside them.
    [[nodiscard]] std::vector<std::uint32_t> find_column() const {
        const std::uint32_t head = bones_[Role::head];
        if (rest_.is_below(head, bones_[Role::hips])) return joints_between(scene_, bones_[Role::hips], head);
        const std::uint32_t spine = bones_[Role::spine];
        if (spine == kNone || !rest_.is_below(head, spine)) return {};
        std::vector<std::uint32_t> column = joints_between(scene_, spine, head);
        column.insert(column.begin(), spine);
        return column;
    }

    /// The joint of the column that the arms leave from: their common ancestor or, if they hang on a control, the
    /// highest below their middle. Its end if they leave from the hips; nothing if they are not beside the column.
    [[nodiscard]] std::optional<std::size_t> find_chest(const std::vector<std::uint32_t>& column) const {
        if (!has_arms()) return column.empty() ? std::nullopt : std::optional(column.size() - 1);
        const std::uint32_t left = bones_[Role::left_upper_arm];
        const std::uint32_t right = bones_[Role::right_upper_arm];
        const std::uint32_t arms = common_ancestor(scene_, rest_, {left, right});
        if (arms == bones_[Role::hips]) return column.size();
        const auto chest = std::find(column.begin(), column.end(), arms);
        if (chest != column.end()) return static_cast<std::size_t>(chest - column.begin());
        const bool hang_elsewhere =
            arms == kNone || rest_.is_below(bones_[Role::hips], arms) ||
            (!rest_.is_below(arms, bones_[Role::hips]) && !column.empty() && !rest_.is_below(arms, column.front()));
        const glm::dvec3 hips = rest_.position(bones_[Role::hips]);
        const glm::dvec3 trunk = rest_.position(bones_[Role::head]) - hips;
        const glm::dvec3 middle = 0.5 * (rest_.position(left) + rest_.position(right)) - hips;
        const double along = glm::dot(middle, trunk) / glm::dot(trunk, trunk);
        if (!hang_elsewhere || column.empty() || !(along > 0.3) || !(along < 1.1) ||
            glm::length(middle - along * trunk) > 0.3 * glm::length(trunk)) {
            return std::nullopt;
        }
        std::size_t highest = 0;
        for (std::size_t k = 0; k < column.size(); ++k) {
            if (glm::dot(rest_.position(column[k]) - hips, trunk) < glm::dot(middle, trunk)) highest = k;
        }
        return highest;
    }

    /// Names the joints from the hips to the head. False if the arms do not leave from there.
    bool find_trunk() {
        std::vector<std::uint32_t> path = find_column();
        const std::optional<std::size_t> chest = find_chest(path);
        if (!chest) return false;
        auto neck = std::find(path.begin(), path.end(), bones_[Role::neck]);
        if (neck == path.end())
            neck = path.begin() + static_cast<std::ptrdiff_t>(*chest == path.size() ? 0 : *chest + 1);
        bones_[Role::neck] = neck == path.end() ? kNone : *neck;
        path.erase(neck, path.end());
        // Some rigs have a joint `Hips` above the legs' joint, which carries the spine alone.
        std::erase_if(path, [&](std::uint32_t joint) { return is_named(joint, BodyPart::hips); });
        if (path.empty() && !has_arms()) return false;
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

}  // namespace

std::optional<Humanoid> complete_human(const Scene& scene, const RestFrames& rest, const NamedHumanoid& found) {
    return HumanCompleter(scene, rest, found).find();
}

/// The joints from one below `top` down to `joint`, without `joint`.
std::vector<std::uint32_t> joints_between(const Scene& scene, std::uint32_t top, std::uint32_t joint) {
    std::vector<std::uint32_t> path;
    for (std::uint32_t at = scene.joints[joint].parent; at != kNone && at != top; at = scene.joints[at].parent)
        path.push_back(at);
    std::reverse(path.begin(), path.end());
    return path;
}

}  // namespace bendy::converter
