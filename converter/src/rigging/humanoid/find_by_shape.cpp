#include "find_humanoid.h"
#include "mirrored_chains.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>

namespace bendy::converter {
namespace {

/// Two mirrored limbs of two long bones each.
struct LimbPair {
    const MirroredChains* chains = nullptr;
    std::size_t root = 0, middle = 0, end = 0;                      ///< into the chains' joints
    double length = 0.0;                                            ///< of both bones, metres
    double score = 0.0;                                             ///< 0 to 1
    glm::dvec3 root_place{0.0}, middle_place{0.0}, end_place{0.0};  ///< halfway between both sides
};

class ShapeFinder {
public:
    ShapeFinder(const Scene& scene, const RestFrames& rest, const ClipRotations& clips, const std::vector<bool>& chosen)
        : scene_(scene), rest_(rest), clips_(clips), chains_(find_mirrored_chains(scene, rest, chosen)) {
        for (const MirroredChains& chains : chains_) add_limb_pairs(chains);
    }

    [[nodiscard]] std::optional<ShapedHumanoid> find() const {
        const LimbPair* best_legs = nullptr;
        const LimbPair* best_arms = nullptr;
        double best = 0.0;
        for (const LimbPair& legs : pairs_) {
            for (const LimbPair& arms : pairs_) {
                if (legs.score * arms.score <= best || !is_human(legs, arms)) continue;
                best = legs.score * arms.score;
                best_legs = &legs;
                best_arms = &arms;
            }
        }
        if (best_legs == nullptr) return std::nullopt;
        return name_bones(*best_legs, *best_arms);
    }

private:
    [[nodiscard]] double distance(std::uint32_t a, std::uint32_t b) const {
        return glm::distance(rest_.position(a), rest_.position(b));
    }

    [[nodiscard]] glm::dvec3 halfway(const MirroredChains& chains, std::size_t joint) const {
        return 0.5 * (rest_.position(chains.joints[0][joint]) + rest_.position(chains.joints[1][joint]));
    }

    /// Finds the root, middle and end joints of a chain: two bones of similar length that make up most of it.
    void add_limb_pairs(const MirroredChains& chains) {
        const std::vector<std::uint32_t>& joints = chains.joints[0];
        std::vector<double> along(joints.size());
        for (std::size_t i = 1; i < joints.size(); ++i) along[i] = along[i - 1] + distance(joints[i - 1], joints[i]);
        const std::size_t last = chains.splits_at != 0 ? chains.splits_at : joints.size() - 1;
        LimbPair best;
        for (std::size_t root = 0; root + 2 <= last; ++root) {
            for (std::size_t middle = root + 1; middle < last; ++middle) {
                const std::size_t first_end = chains.splits_at != 0 ? last : middle + 1;
                for (std::size_t end = first_end; end <= last; ++end) {
                    const double upper = distance(joints[root], joints[middle]);
                    const double lower = distance(joints[middle], joints[end]);
                    // Between the three joints the limb must be straight.
                    const bool is_straight =
                        upper > 0.95 * (along[middle] - along[root]) && lower > 0.95 * (along[end] - along[middle]);
                    const double balance = std::min(upper, lower) / std::max(upper, lower);
                    const double cover = (along[end] - along[root]) / along[last];
                    const double score = balance * std::sqrt(cover);
                    if (!is_straight || !(balance > 0.4) || !(score > best.score)) continue;
                    best = {&chains, root, middle, end, upper + lower, score};
                }
            }
        }
        if (best.chains == nullptr) return;
        best.root_place = halfway(chains, best.root);
        best.middle_place = halfway(chains, best.middle);
        best.end_place = halfway(chains, best.end);
        pairs_.push_back(best);
    }

    [[nodiscard]] bool are_apart(const LimbPair& a, const LimbPair& b) const {
        const std::uint32_t first = a.chains->joints[0].front();
        const std::uint32_t second = b.chains->joints[0].front();
        return first != second && !rest_.is_below(first, second) && !rest_.is_below(second, first);
    }

    [[nodiscard]] bool is_human(const LimbPair& legs, const LimbPair& arms) const {
        if (legs.chains == arms.chains || !are_apart(legs, arms)) return false;
        const auto up = unit(legs.root_place - legs.end_place);
        const auto trunk = unit(arms.root_place - legs.root_place);
        if (!up || !trunk) return false;
        const auto height = [&](const glm::dvec3& place) { return glm::dot(place - legs.end_place, *up); };
        const double ratio = arms.length / legs.length;
        const bool stands = up->y > 0.7 && height(legs.root_place) > 0.6 * legs.length;
        const bool is_upright = glm::dot(*trunk, *up) > 0.8 && height(arms.root_place) > 1.3 * height(legs.root_place);
        const bool has_free_arms = height(arms.end_place) > 0.3 * height(legs.root_place);
        const bool agrees = std::abs(glm::dot(legs.chains->across, arms.chains->across)) > 0.9;
        return stands && is_upright && has_free_arms && agrees && ratio > 0.3 && ratio < 3.0;
    }

    // --- left and right

    /// 1 if the names say that the first joint is the left one, -1 if the second is, 0 if they do not tell: they must
    /// differ only in the side.
    [[nodiscard]] static int side_of_names(std::string_view first, std::string_view second) {
        const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
        std::size_t head = 0;
        while (head < std::min(first.size(), second.size()) && first[head] == second[head]) ++head;
        std::size_t tail = 0;
        while (tail < std::min(first.size(), second.size()) - head &&
               first[first.size() - 1 - tail] == second[second.size() - 1 - tail])
            ++tail;
        const auto middle = [&](std::string_view name) {
            std::string text;
            for (const char c : name.substr(head, name.size() - head - tail)) text += lower(c);
            return text;
        };
        const std::string a = middle(first);
        const std::string b = middle(second);
        const auto is_left = [](const std::string& text) { return text == "l" || text == "lef" || text == "left"; };
        const auto is_right = [](const std::string& text) { return text == "r" || text == "righ" || text == "right"; };
        if (is_left(a) && is_right(b)) return 1;
        return is_right(a) && is_left(b) ? -1 : 0;
    }

    /// How clearly the clips bend the limbs towards `way`, a direction in model space at rest; -2 to 2.
    [[nodiscard]] double bend_in_clips(const LimbPair& limbs, const glm::dvec3& way) const {
        double sum = 0.0;
        for (const std::vector<std::uint32_t>& joints : limbs.chains->joints) {
            const auto bend = clips_.bend_of({joints[limbs.root], joints[limbs.middle], joints[limbs.end]});
            const std::uint32_t parent = scene_.joints[joints[limbs.root]].parent;
            if (bend && parent != kNone) sum += bend->agreement * glm::dot(rest_.turn(parent) * bend->direction, way);
        }
        return sum;
    }

    /// The offset of the middle joint from the line from root to end along `way`, as a share of the limb's length.
    [[nodiscard]] static double bend_at_rest(const LimbPair& limbs, const glm::dvec3& way) {
        return glm::dot(limbs.middle_place - 0.5 * (limbs.root_place + limbs.end_place), way) / limbs.length;
    }

    /// Evidence that the first joint in each pair of legs is the left one (above 0: it is): from shape and clips, and
    /// from names.
    struct Votes {
        double shape = 0.0;
        double names = 0.0;
    };
    [[nodiscard]] Votes count_votes(const LimbPair& legs, const LimbPair& arms) const {
        const glm::dvec3 up = *unit(legs.root_place - legs.end_place);
        const glm::dvec3 forward = glm::cross(legs.chains->across, up);  // if the first one is left
        Votes votes;
        for (const LimbPair* limbs : {&legs, &arms}) {
            const bool is_turned = glm::dot(limbs->chains->across, legs.chains->across) < 0.0;
            for (std::size_t joint = limbs->root; joint <= limbs->end; ++joint) {
                const auto name = [&](std::size_t side) -> const std::string& {
                    return scene_.joints[limbs->chains->joints[side][joint]].name;
                };
                votes.names += (is_turned ? -1.0 : 1.0) * side_of_names(name(0), name(1));
            }
        }
        votes.names = std::clamp(votes.names, -2.0, 2.0);
        const std::size_t toes = legs.end + 1;
        if (toes < legs.chains->joints[0].size()) {
            const auto foot = unit(halfway(*legs.chains, toes) - legs.end_place);
            if (foot) votes.shape += 3.0 * glm::dot(*foot, forward);
        }
        votes.shape += 20.0 * bend_at_rest(legs, forward) - 5.0 * bend_at_rest(arms, forward);
        votes.shape += 1.5 * bend_in_clips(legs, forward) - 0.5 * bend_in_clips(arms, forward);
        votes.shape += 0.1 * forward.z;
        return votes;
    }

    // --- names

    [[nodiscard]] ShapedHumanoid name_bones(const LimbPair& legs, const LimbPair& arms) const {
        ShapedHumanoid found;
        Humanoid& bones = found.bones;
        const Votes votes = count_votes(legs, arms);
        const bool is_left = votes.shape + votes.names >= 0.0;
        found.contradicts_names = votes.names != 0.0 && (votes.names > 0.0) != is_left;
        const bool is_turned = glm::dot(legs.chains->across, arms.chains->across) < 0.0;
        for (const bool right : {false, true}) {
            const auto set = [&](HumanBone left, std::uint32_t joint) { bones[right ? mirrored(left) : left] = joint; };
            const auto& leg = legs.chains->joints[is_left != right ? 0 : 1];
            const auto& arm = arms.chains->joints[(is_left != is_turned) != right ? 0 : 1];
            set(HumanBone::left_upper_leg, leg[legs.root]);
            set(HumanBone::left_lower_leg, leg[legs.middle]);
            set(HumanBone::left_foot, leg[legs.end]);
            if (legs.end + 1 < leg.size()) set(HumanBone::left_toes, leg[legs.end + 1]);
            if (arms.root > 0) set(HumanBone::left_shoulder, arm[arms.root - 1]);
            set(HumanBone::left_upper_arm, arm[arms.root]);
            set(HumanBone::left_lower_arm, arm[arms.middle]);
            set(HumanBone::left_hand, arm[arms.end]);
        }
        return found;
    }

    const Scene& scene_;
    const RestFrames& rest_;
    const ClipRotations& clips_;
    std::vector<MirroredChains> chains_;
    std::vector<LimbPair> pairs_;
};

}  // namespace

std::optional<ShapedHumanoid> find_by_shape(const Scene& scene, const RestFrames& rest, const ClipRotations& clips,
                                            const std::vector<bool>& chosen) {
    std::optional<ShapedHumanoid> found = ShapeFinder(scene, rest, clips, chosen).find();
    if (found) find_trunk_by_shape(scene, rest, chosen, found->bones);
    return found;
}

void find_trunk_by_shape(const Scene& scene, const RestFrames& rest, const std::vector<bool>& chosen,
                         Humanoid& humanoid) {
    const auto those = [&](std::initializer_list<HumanBone> bones) {
        std::vector<std::uint32_t> joints;
        for (const HumanBone bone : bones) {
            if (humanoid.has(bone)) joints.push_back(humanoid[bone]);
        }
        return joints;
    };
    const std::vector<std::uint32_t> legs = those({HumanBone::left_upper_leg, HumanBone::right_upper_leg});
    const std::vector<std::uint32_t> arms = those({HumanBone::left_upper_arm, HumanBone::right_upper_arm});
    if (legs.size() != 2 || arms.size() != 2) return;
    const std::uint32_t hips = common_ancestor(scene, rest, legs);
    const std::uint32_t shoulders = common_ancestor(scene, rest, arms);
    if (hips == kNone || shoulders == kNone) return;
    const auto up =
        unit(rest.position(arms[0]) + rest.position(arms[1]) - rest.position(legs[0]) - rest.position(legs[1]));
    if (!up) return;
    if (!humanoid.has(HumanBone::hips)) humanoid[HumanBone::hips] = hips;

    if (!humanoid.has(HumanBone::head)) {
        // The branch that continues upward from where the arms leave, on neither side of them.
        const std::vector<std::vector<std::uint32_t>> children = list_children(scene, chosen);
        const auto carries_limb = [&](std::uint32_t joint) {
            return std::any_of(arms.begin(), arms.end(),
                               [&](std::uint32_t arm) { return joint == arm || rest.is_below(arm, joint); }) ||
                   std::any_of(legs.begin(), legs.end(),
                               [&](std::uint32_t leg) { return joint == leg || rest.is_below(leg, joint); });
        };
        const glm::dvec3 between = 0.5 * (rest.position(arms[0]) + rest.position(arms[1]));
        const double width = glm::distance(rest.position(arms[0]), rest.position(arms[1]));
        std::vector<std::uint32_t> path;
        for (std::uint32_t at = shoulders; at != kNone && path.size() < 8;) {
            std::uint32_t next = kNone;
            double highest = 0.0;
            for (const std::uint32_t child : children[at]) {
                if (carries_limb(child)) continue;
                const glm::dvec3 from = rest.position(child) - between;
                const double height = glm::dot(from, *up);
                if (glm::length(from - height * *up) > 0.5 * width || height <= highest) continue;
                highest = height;
                next = child;
            }
            // The joint where it branches, into eyes and jaw, is the head.
            if (!path.empty() && children[at].size() > 1) break;
            if (next != kNone) path.push_back(next);
            at = next;
        }
        if (!path.empty()) {
            humanoid[HumanBone::head] = path.back();
            if (path.size() > 1 && !humanoid.has(HumanBone::neck)) humanoid[HumanBone::neck] = path.front();
        }
    }
    if (humanoid.has(HumanBone::head) && !humanoid.has(HumanBone::spine)) {
        const std::uint32_t top = humanoid.has(HumanBone::neck) ? humanoid[HumanBone::neck] : humanoid[HumanBone::head];
        // The joints from the common ancestor of legs and arms to the neck; if the trunk has its own root, that too.
        std::vector<std::uint32_t> limbs = legs;
        limbs.insert(limbs.end(), arms.begin(), arms.end());
        const std::uint32_t base = common_ancestor(scene, rest, limbs);
        std::uint32_t first = kNone;
        for (std::uint32_t joint = scene.joints[top].parent; joint != kNone && joint != base;
             joint = scene.joints[joint].parent)
            first = joint;
        if (first != kNone) humanoid[HumanBone::spine] = first;
    }
}

}  // namespace bendy::converter
