#include "animal.h"

#include "humanoid.h"
#include "mirrored_chains.h"
#include "scene/space.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace bendy::converter {
namespace {

/// The part of a pair of mirrored chains from where the legs leave the trunk to the feet.
struct LegPair {
    const MirroredChains* chains = nullptr;
    std::size_t root = 0, foot = 0;
    std::size_t first = 0;                        ///< as root, of legs that spread sideways
    double length = 0.0;                          ///< metres along the bones
    glm::dvec3 root_place{0.0}, foot_place{0.0};  ///< halfway between both sides
    glm::dvec3 up{0.0, 1.0, 0.0};                 ///< unit, from the feet to the roots
    double width = 0.0;                           ///< metres between the roots
    std::uint32_t anchor = kNone;                 ///< the joint that carries both
};

/// The chosen joints, and the ends of limbs that move no vertices: leaves below the last chosen joint.
std::vector<bool> with_ends(const Scene& scene, const std::vector<bool>& chosen) {
    std::vector<bool> has_chosen(scene.joints.size());
    std::vector<bool> has_any(scene.joints.size());
    for (std::size_t joint = 0; joint < scene.joints.size(); ++joint) {
        const std::uint32_t parent = scene.joints[joint].parent;
        if (parent == kNone) continue;
        has_any[parent] = true;
        if (chosen[joint]) has_chosen[parent] = true;
    }
    std::vector<bool> all = chosen;
    for (std::size_t joint = 0; joint < scene.joints.size(); ++joint) {
        const std::uint32_t parent = scene.joints[joint].parent;
        if (parent != kNone && !has_any[joint] && chosen[parent] && !has_chosen[parent]) all[joint] = true;
    }
    return all;
}

class AnimalFinder {
public:
    AnimalFinder(const Scene& scene, const RestFrames& rest, const std::vector<bool>& chosen)
        : scene_(scene),
          rest_(rest),
          children_(list_children(scene, chosen)),
          chains_(find_mirrored_chains(scene, rest, with_ends(scene, chosen))) {
        measure_reach();
        for (std::uint32_t joint = 0; joint < scene.joints.size(); ++joint) {
            if (chosen[joint]) lowest_ = std::min(lowest_, rest.position(joint).y);
        }
        for (const MirroredChains& chains : chains_) add_legs(chains);
    }

    [[nodiscard]] std::optional<Animal> find() {
        std::vector<LegPair> all = find_all_legs();
        if (all.empty()) return std::nullopt;
        const auto [a, b] = std::pair(all[0], all[1]);
        mark_trunk(all);
        const std::vector<std::uint32_t> of_a = outgrowth(a, b);
        const std::vector<std::uint32_t> of_b = outgrowth(b, a);
        const auto from_b_to_a = unit_across(a.root_place - b.root_place, unit(a.up + b.up).value_or(a.up));
        if (!from_b_to_a) return std::nullopt;
        const bool is_a_front = front_vote(a, of_a, b, of_b, *from_b_to_a) >= 0.0;
        const glm::dvec3 forward = is_a_front ? *from_b_to_a : -*from_b_to_a;
        std::stable_sort(all.begin(), all.end(), [&](const LegPair& first, const LegPair& second) {
            return glm::dot(first.root_place - second.root_place, forward) > 0.0;
        });
        return is_a_front ? describe(all, of_a, of_b, forward) : describe(all, of_b, of_a, forward);
    }

private:
    static constexpr double kGround = 0.25;     // of a leg's length: for feet, from one another and from the ground
    static constexpr double kShortBone = 0.15;  // of a leg's length: a toe tip, or a joint that only attaches the leg

    void measure_reach() {
        reach_.assign(children_.size(), 0.0);
        for (auto joint = static_cast<std::uint32_t>(children_.size()); joint-- > 0;) {
            for (const std::uint32_t child : children_[joint])
                reach_[joint] = std::max(reach_[joint], reach_to(joint, child));
        }
    }
    [[nodiscard]] double reach_to(std::uint32_t joint, std::uint32_t child) const {
        return glm::distance(rest_.position(joint), rest_.position(child)) + reach_[child];
    }

    // --- legs

    [[nodiscard]] glm::dvec3 halfway(const MirroredChains& chains, std::size_t joint) const {
        return 0.5 * (rest_.position(chains.joints[0][joint]) + rest_.position(chains.joints[1][joint]));
    }

    void add_legs(const MirroredChains& chains) {
        const std::vector<std::uint32_t>& joints = chains.joints[0];
        const std::size_t last = chains.splits_at != 0 ? chains.splits_at : joints.size() - 1;
        const auto bone = [&](std::size_t i) {
            return glm::distance(rest_.position(joints[i]), rest_.position(joints[i + 1]));
        };
        LegPair legs;
        legs.chains = &chains;
        for (std::size_t i = 0; i < last; ++i) legs.length += bone(i);
        const double shortest = kShortBone * legs.length;
        const auto runs_across = [&](std::size_t i) {
            const auto way = rest_.direction(joints[i], joints[i + 1]);
            return way && std::abs(glm::dot(*way, chains.across)) > 0.7;
        };
        legs.foot = last;
        while (legs.foot > 2 && bone(legs.foot - 1) < shortest) --legs.foot;
        while (legs.first + 2 < legs.foot && bone(legs.first) < shortest) ++legs.first;
        legs.root = legs.first;
        while (legs.root + 2 < legs.foot && (bone(legs.root) < shortest || runs_across(legs.root))) ++legs.root;
        legs.root_place = halfway(chains, legs.root);
        legs.foot_place = halfway(chains, legs.foot);
        legs.width =
            glm::distance(rest_.position(chains.joints[0][legs.root]), rest_.position(chains.joints[1][legs.root]));
        const auto up = unit(legs.root_place - legs.foot_place);
        legs.anchor = common_ancestor(scene_, rest_, {chains.joints[0].front(), chains.joints[1].front()});
        if (!up || legs.anchor == kNone) return;
        // Skirts, braids and coats hang, but do not stand.
        if (legs.foot_place.y - lowest_ > kGround * legs.length) return;
        if (up->y > 0.7) {
            legs.up = *up;
            legs_.push_back(legs);
        } else if (highest_of(legs) - legs.foot_place.y > 0.1 * legs.length && !is_wing_or_ear(legs)) {
            splayed_.push_back(legs);
        }
    }

    [[nodiscard]] bool is_wing_or_ear(const LegPair& legs) const {
        return std::any_of(legs.chains->joints[0].begin(), legs.chains->joints[0].end(), [&](std::uint32_t joint) {
            const NameWords name(scene_.joints[joint].name);
            return name.has("wing") || name.has("ear");
        });
    }

    [[nodiscard]] double highest_of(const LegPair& legs) const {
        double highest = -std::numeric_limits<double>::infinity();
        for (std::size_t joint = legs.root; joint <= legs.foot; ++joint)
            highest = std::max(highest, halfway(*legs.chains, joint).y);
        return highest;
    }

    /// All pairs that stand, the two that are farthest apart first; nothing for fewer than two. Legs that point forward
    /// or back, as a spider's, are legs if there are six.
    [[nodiscard]] std::vector<LegPair> find_all_legs() const {
        std::vector<LegPair> best;
        for (std::size_t i = 0; i < legs_.size(); ++i) {
            for (std::size_t j = i + 1; j < legs_.size(); ++j) {
                if (!stand_together(legs_[i], legs_[j])) continue;
                std::vector<LegPair> all = with_others({legs_[i], legs_[j]}, legs_);
                if (is_better(all, best)) best = std::move(all);
            }
        }
        std::vector<LegPair> candidates = legs_;
        candidates.insert(candidates.end(), splayed_.begin(), splayed_.end());
        for (const LegPair& first : candidates) {
            std::vector<LegPair> all = with_others({first}, candidates);
            if (all.size() > 2 && is_better(all, best)) best = farthest_first(std::move(all));
        }
        return spread(std::move(best));
    }

    /// Similar legs mirror in two planes. A trunk is longer than wide; of six legs, names and the front say more.
    [[nodiscard]] bool is_better(const std::vector<LegPair>& all, const std::vector<LegPair>& than) const {
        if (all.size() != than.size()) return all.size() > than.size();
        if (all.size() == 2) return trunk_of(all) > trunk_of(than);
        const std::size_t named = count_sides(all);
        const std::size_t others = count_sides(than);
        if (named != others) return named > others;
        return std::abs(all[0].chains->across.x) > std::abs(than[0].chains->across.x);
    }

    /// How many pairs have a left and a right leg by name.
    [[nodiscard]] std::size_t count_sides(const std::vector<LegPair>& all) const {
        return static_cast<std::size_t>(std::count_if(all.begin(), all.end(), [&](const LegPair& legs) {
            const BodySide a = NameWords(scene_.joints[legs.chains->joints[0].front()].name).side();
            const BodySide b = NameWords(scene_.joints[legs.chains->joints[1].front()].name).side();
            return a != b && a != BodySide::none && b != BodySide::none;
        }));
    }

    [[nodiscard]] static double trunk_of(const std::vector<LegPair>& all) {
        return glm::distance(all[0].root_place, all[1].root_place);
    }

    [[nodiscard]] static std::vector<LegPair> farthest_first(std::vector<LegPair> all) {
        std::pair<std::size_t, std::size_t> ends(0, 1);
        double most = -1.0;
        for (std::size_t i = 0; i < all.size(); ++i) {
            for (std::size_t j = i + 1; j < all.size(); ++j) {
                const double apart = glm::distance(all[i].foot_place, all[j].foot_place);
                if (apart > most) ends = {i, j};
                most = std::max(most, apart);
            }
        }
        std::swap(all[0], all[ends.first]);
        std::swap(all[1], all[ends.second]);
        return all;
    }

    /// Six legs and more begin where they leave the body, even if they first run sideways.
    [[nodiscard]] std::vector<LegPair> spread(std::vector<LegPair> all) const {
        for (LegPair& legs : all) {
            if (all.size() == 2) break;
            legs.root = legs.first;
            legs.root_place = halfway(*legs.chains, legs.root);
        }
        return all;
    }

    /// Adds those of the candidates that are like all others.
    [[nodiscard]] std::vector<LegPair> with_others(std::vector<LegPair> all,
                                                   const std::vector<LegPair>& candidates) const {
        for (const LegPair& legs : candidates) {
            const bool is_one_of_them = std::all_of(all.begin(), all.end(), [&](const LegPair& other) {
                return have_joints_of_their_own(legs, other) && are_alike(legs, other);
            });
            if (is_one_of_them) all.push_back(legs);
        }
        return all;
    }

    /// Whether none of the legs hangs on one of the other pair.
    [[nodiscard]] bool have_joints_of_their_own(const LegPair& a, const LegPair& b) const {
        for (const auto& first : a.chains->joints) {
            for (const auto& second : b.chains->joints) {
                if (first.front() == second.front() || rest_.is_below(first.front(), second.front()) ||
                    rest_.is_below(second.front(), first.front()))
                    return false;
            }
        }
        return true;
    }

    /// Whether both stand on the same ground, across the same trunk, with legs of similar length.
    [[nodiscard]] static bool are_alike(const LegPair& a, const LegPair& b) {
        const double length = 0.5 * (a.length + b.length);
        const double ratio = a.length / b.length;
        const bool is_one_ground = std::abs(a.foot_place.y - b.foot_place.y) < kGround * length;
        return is_one_ground && std::abs(glm::dot(a.chains->across, b.chains->across)) > 0.9 && ratio > 0.4 &&
               ratio < 2.5;
    }

    [[nodiscard]] bool stand_together(const LegPair& a, const LegPair& b) const {
        if (!have_joints_of_their_own(a, b) || !are_alike(a, b)) return false;
        const auto up = unit(a.up + b.up);
        const auto trunk = unit(a.root_place - b.root_place);
        if (!up || !trunk) return false;
        const double length = 0.5 * (a.length + b.length);
        // Feet of an IK rig, which stand before and behind the legs, point forward.
        const bool is_one_ground = std::abs(glm::dot(a.foot_place - b.foot_place, *up)) < kGround * length;
        const bool is_level = std::abs(glm::dot(*trunk, *up)) < 0.5;
        // Some legs begin with a shoulder blade and a pelvis, which meet in the middle of the back.
        const bool has_trunk = std::max(glm::distance(a.root_place, b.root_place),
                                        glm::distance(a.foot_place, b.foot_place)) > 0.3 * length;
        return is_one_ground && is_level && has_trunk && std::abs(glm::dot(a.chains->across, *trunk)) < 0.3;
    }

    // --- trunk

    /// Marks the joints between the pairs, and those that carry a leg.
    void mark_trunk(const std::vector<LegPair>& all) {
        is_trunk_.assign(children_.size(), false);
        for (const LegPair& legs : all) {
            for (const auto& side : legs.chains->joints) {
                for (std::uint32_t joint = side.front(); joint != kNone; joint = scene_.joints[joint].parent)
                    is_trunk_[joint] = true;
            }
        }
    }

    /// The branch that continues from the joint that carries the legs, in the middle between them: neck and head, or
    /// tail. It follows the longest branch, and ends at the head if a name identifies it.
    [[nodiscard]] std::vector<std::uint32_t> outgrowth(const LegPair& legs, const LegPair& others) const {
        const glm::dvec3 middle = 0.5 * (legs.root_place + others.root_place);
        const auto is_on_this_side = [&](std::uint32_t joint) {
            return glm::dot(rest_.position(joint) - middle, legs.root_place - others.root_place) > 0.0;
        };
        std::vector<std::uint32_t> path;
        for (std::uint32_t at = legs.anchor; at != kNone;) {
            std::uint32_t next = kNone;
            double longest = -1.0;
            for (const std::uint32_t child : children_[at]) {
                const bool may_curl = !path.empty() && children_[at].size() == 1;
                if (path.empty() && !is_on_this_side(child)) continue;
                if (is_trunk_[child] || (!may_curl && !is_in_middle(legs, child, children_[at]))) continue;
                const double reach = is_head(child) ? std::numeric_limits<double>::max() : reach_to(at, child);
                if (reach <= longest) continue;
                longest = reach;
                next = child;
            }
            if (next != kNone) path.push_back(next);
            if (next != kNone && is_head(next)) break;
            at = next;
        }
        return path;
    }

    /// Whether a joint lies in the mirror plane of the legs; one of a pair of ears does not.
    [[nodiscard]] bool is_in_middle(const LegPair& legs, std::uint32_t joint,
                                    const std::vector<std::uint32_t>& siblings) const {
        const auto side = [&](std::uint32_t of) {
            return glm::dot(rest_.position(of) - legs.root_place, legs.chains->across);
        };
        const double beside = side(joint);
        if (std::abs(beside) > 0.25 * legs.width) return false;
        if (std::abs(beside) < 1e-3 * legs.width) return true;
        constexpr std::size_t kMostSiblings = 64;  // that are compared
        const auto end = siblings.begin() + static_cast<std::ptrdiff_t>(std::min(siblings.size(), kMostSiblings));
        return std::none_of(siblings.begin(), end, [&](std::uint32_t other) {
            const glm::dvec3 mirrored = rest_.position(joint) - 2.0 * beside * legs.chains->across;
            return other != joint && glm::distance(rest_.position(other), mirrored) < 0.5 * std::abs(beside);
        });
    }

    [[nodiscard]] bool is_head(std::uint32_t joint) const {
        const std::optional<BoneName> name = read_bone_name(scene_.joints[joint].name);
        return name && name->part == BodyPart::head;
    }

    /// 1 if the legs' names say that they are front legs, -1 for hind legs, 0 if they do not tell.
    [[nodiscard]] int front_by_name(const LegPair& legs) const {
        int front = 0;
        for (const std::uint32_t joint : legs.chains->joints[0]) {
            const NameWords name(scene_.joints[joint].name);
            if (name.has("front") || name.has("fore")) ++front;
            if (name.has("back") || name.has("hind") || name.has("rear")) --front;
        }
        return std::clamp(front, -1, 1);
    }

    /// Above 0 if `a` is in front.
    [[nodiscard]] double front_vote(const LegPair& a, const std::vector<std::uint32_t>& of_a, const LegPair& b,
                                    const std::vector<std::uint32_t>& of_b, const glm::dvec3& from_b_to_a) const {
        if (const int named = front_by_name(a) - front_by_name(b); named != 0) return named;
        const auto ends_with_head = [&](const std::vector<std::uint32_t>& path) {
            return !path.empty() && is_head(path.back());
        };
        if (ends_with_head(of_a) != ends_with_head(of_b)) return ends_with_head(of_a) ? 1.0 : -1.0;
        double vote = 0.0;
        for (const LegPair* legs : {&a, &b}) {
            const std::size_t toes = legs->foot + 1;
            if (toes >= legs->chains->joints[0].size()) continue;
            if (const auto way = unit(halfway(*legs->chains, toes) - legs->foot_place))
                vote += glm::dot(*way, from_b_to_a);
        }
        const auto height = [&](const std::vector<std::uint32_t>& path, const LegPair& legs) {
            return path.empty() ? 0.0 : glm::dot(rest_.position(path.back()) - legs.root_place, legs.up) / legs.length;
        };
        return vote + 2.0 * (height(of_a, a) - height(of_b, b)) + 0.01 * from_b_to_a.z;
    }

    /// \param all  from the front
    [[nodiscard]] std::optional<Animal> describe(const std::vector<LegPair>& all, std::vector<std::uint32_t> neck,
                                                 std::vector<std::uint32_t> tail, const glm::dvec3& forward) const {
        const auto up = unit_across(all.front().up + all.back().up, forward);
        if (!up) return std::nullopt;
        Animal found;
        found.stance = {glm::cross(*up, forward), *up, forward};
        for (const LegPair& legs : all) {
            const bool is_first_left = glm::dot(legs.chains->across, found.stance.left) > 0.0;
            for (const std::size_t side : {0u, 1u}) {
                const std::vector<std::uint32_t>& joints = legs.chains->joints[is_first_left ? side : 1 - side];
                const auto below = joints.begin() + static_cast<std::ptrdiff_t>(legs.foot) + 1;
                found.legs.emplace_back(joints.begin() + static_cast<std::ptrdiff_t>(legs.root), below);
                found.paws.emplace_back(below, joints.end());
                found.targets.push_back(find_target(found.legs.back()));
            }
        }
        found.spine = find_spine(all.front().anchor, all.back().anchor);
        if (neck.empty() && !tail.empty() && is_head(tail.back())) std::swap(neck, tail);
        cut_at_head(neck);
        found.neck = std::move(neck);
        found.tail = std::move(tail);
        return found;
    }

    /// A joint outside the leg at the rest position of the leg's end, such as a control of an IK rig; kNone if there is
    /// none.
    [[nodiscard]] std::uint32_t find_target(const std::vector<std::uint32_t>& leg) const {
        const glm::dvec3 end = rest_.position(leg.back());
        double length = 0.0;
        for (std::size_t i = 1; i < leg.size(); ++i)
            length += glm::distance(rest_.position(leg[i - 1]), rest_.position(leg[i]));
        for (std::uint32_t joint = 0; joint < scene_.joints.size(); ++joint) {
            const bool is_outside =
                joint != leg.front() && !rest_.is_below(joint, leg.front()) && !rest_.is_below(leg.front(), joint);
            if (is_outside && glm::distance(rest_.position(joint), end) < 0.01 * length) return joint;
        }
        return kNone;
    }

    /// The spine from the hind legs to the front ones; reversed if the skeleton's root is at the front. Without the
    /// first joint, which carries legs.
    [[nodiscard]] std::vector<std::uint32_t> find_spine(std::uint32_t front, std::uint32_t hind) const {
        std::vector<std::uint32_t> spine = path_of(scene_, hind, front);
        if (spine.empty()) spine = path_of(scene_, front, hind);
        if (spine.empty()) {
            const std::uint32_t base = common_ancestor(scene_, rest_, {front, hind});
            if (base != kNone) spine = path_of(scene_, base, front);
        }
        if (!spine.empty()) spine.erase(spine.begin());
        return spine;
    }

    /// Cuts the neck at the head. Without a name, the head is where the neck branches into eyes, ears and jaw, or else
    /// its last joint.
    void cut_at_head(std::vector<std::uint32_t>& neck) const {
        if (neck.empty() || is_head(neck.back())) return;
        const auto head = std::find_if(neck.begin() + 1, neck.end(),
                                       [&](std::uint32_t joint) { return children_[joint].size() > 1; });
        if (head != neck.end()) neck.erase(head + 1, neck.end());
    }

    const Scene& scene_;
    const RestFrames& rest_;
    std::vector<std::vector<std::uint32_t>> children_;
    std::vector<MirroredChains> chains_;
    double lowest_ = std::numeric_limits<double>::infinity();  ///< height of the lowest joint, metres
    std::vector<double> reach_;  ///< metres from the joint to its farthest descendant, along the bones
    std::vector<LegPair> legs_;
    std::vector<LegPair> splayed_;  ///< whose feet are far in front of their roots, or behind
    std::vector<bool> is_trunk_;
};

// Typical ranges. Legs: Jaegger, Marcellin-Little & Levine, Reliability of goniometry in Labrador Retrievers (2002):
//   bends of elbow 15 to 144, carpus -16 to 148, stifle 18 to 138, hock 16 to 141; shoulder and hip turn by 108 and 112
//   in total. The other ranges are our choice, relative to the rest pose.
constexpr Ranges kLeg{{-20, 20}, {-60, 60}, {-20, 30}};         // Y: forward and back; Z forward: + outward
constexpr Ranges kBentJoint{{-15, 15}, {-10, 10}, {-15, 150}};  // Z the bend
constexpr Ranges kStraightJoint{{-15, 15}, {-10, 10}, {-90, 90}};
constexpr Ranges kBack{{-30, 30}, {-45, 45}, {-45, 45}};  // all joints together
constexpr Ranges kNeckOfAnimal{{-60, 60}, {-90, 90}, {-90, 90}};
constexpr Ranges kTail{{-45, 45}, {-90, 90}, {-120, 120}};
constexpr double kHardlyBent = 5.0;    // degrees: less does not show to which side a joint bends
constexpr double kClearlyBent = 20.0;  // degrees

}  // namespace

std::optional<Animal> find_animal(const Scene& scene, const RestFrames& rest, const std::vector<bool>& chosen) {
    return AnimalFinder(scene, rest, chosen).find();
}

std::vector<Chain> make_animal_chains(const Scene& scene, const RestFrames& rest, const Animal& found,
                                      std::uint8_t flags) {
    constexpr std::array<const char*, kFourLegs> kLegs{"LeftFrontLeg", "RightFrontLeg", "LeftHindLeg", "RightHindLeg"};
    const auto name_of = [&](std::size_t leg) {
        if (found.legs.size() == kFourLegs) return std::string(kLegs[leg]);
        return (leg % 2 == 0 ? "LeftLeg" : "RightLeg") + std::to_string(leg / 2 + 1);
    };
    std::vector<Chain> chains;
    for (std::size_t leg = 0; leg < found.legs.size(); ++leg) {
        const std::vector<std::uint32_t>& joints = found.legs[leg];
        const bool is_two_bone = joints.size() == 3;
        Chain chain = make_chain(name_of(leg), joints.front(), joints.back(),
                                 is_two_bone ? Solver::two_bone : Solver::any, flags);
        if (is_two_bone) {
            const auto bend = bend_of(rest, joints[0], joints[1], rest.position(joints[2]));
            const auto pole = bend ? rest.to_space_of(scene.joints[joints[0]].parent, *bend) : std::nullopt;
            if (pole) chain.record.pole_vector = to_array<3>(*pole);
        }
        chain.record.target = found.targets[leg];
        for (const std::uint32_t joint : path_of(scene, joints.front(), joints.back())) {
            if (std::find(joints.begin(), joints.end(), joint) == joints.end()) chain.weights.push_back({joint, 0.0f});
        }
        chains.push_back(std::move(chain));
    }
    const auto add = [&](const char* name, std::uint32_t start, std::uint32_t effector) {
        if (rest.is_below(effector, start)) chains.push_back(make_chain(name, start, effector, Solver::ccd, flags));
    };
    if (!found.spine.empty()) {
        const bool goes_on = !found.neck.empty() && rest.is_below(found.neck.front(), found.spine.back());
        add("Spine", found.spine.front(), goes_on ? found.neck.front() : found.spine.back());
    }
    if (!found.neck.empty()) add("Neck", found.neck.front(), found.neck.back());
    if (!found.tail.empty()) add("Tail", found.tail.front(), found.tail.back());
    return chains;
}

std::vector<JointAnatomy> find_anatomy(const RestFrames& rest, const Animal& found) {
    const Stance& stance = found.stance;
    AnatomyBuilder joints(rest, stance);
    const auto head = found.neck.empty() ? kNone : found.neck.front();
    const bool goes_on = !found.spine.empty() && head != kNone && rest.is_below(head, found.spine.back());
    joints.add_column(found.spine, goes_on ? head : kNone, BodyJoint::spine, kBack, stance.forward);
    joints.add_column(found.neck, kNone, BodyJoint::neck, kNeckOfAnimal, stance.forward);
    joints.add_column(found.tail, kNone, BodyJoint::tail, kTail, -stance.forward);
    for (const bool right : {false, true}) {
        joints.set_side(right);
        for (const bool hind : {false, true}) {
            const std::vector<std::uint32_t>& leg =
                found.legs[(hind ? Animal::left_hind : Animal::left_front) + (right ? 1 : 0)];
            joints.add_swing(leg[0], hind ? BodyJoint::hind_leg : BodyJoint::front_leg, joints.along(leg[0], leg[1]),
                             stance.forward, kLeg);
            for (std::size_t i = 1; i + 1 < leg.size(); ++i) {
                const glm::dvec3 end = rest.position(leg[i + 1]);
                const auto bent = joints.bend_between(leg[i - 1], leg[i], end);
                const double angle = bent ? glm::length(*bent) : 0.0;
                const glm::dvec3 towards = angle > kHardlyBent ? end - rest.position(leg[i]) : stance.forward;
                joints.add_bend(leg[i - 1], leg[i], hind ? BodyJoint::hind_leg_joint : BodyJoint::front_leg_joint, end,
                                towards, angle > kClearlyBent ? kBentJoint : kStraightJoint, i);
            }
        }
    }
    return joints.take();
}

}  // namespace bendy::converter
