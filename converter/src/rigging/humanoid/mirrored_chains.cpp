#include "mirrored_chains.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <optional>
#include <utility>

namespace bendy::converter {
namespace {

class ChainFinder {
public:
    ChainFinder(const Scene& scene, const RestFrames& rest, const std::vector<bool>& chosen)
        : rest_(rest), children_(list_children(scene, chosen)) {
        measure_reach();
        for (std::uint32_t joint = 0; joint < scene.joints.size(); ++joint) {
            if (chosen[joint]) find_pairs_below(joint);
        }
    }

    [[nodiscard]] std::vector<MirroredChains> take() { return std::move(chains_); }

private:
    static constexpr std::size_t kMostChildren = 12;  // per joint; compared pairwise
    static constexpr std::size_t kMostChains = 64;
    static constexpr std::size_t kMostJoints = 24;  // per chain

    [[nodiscard]] double distance(std::uint32_t a, std::uint32_t b) const {
        return glm::distance(rest_.position(a), rest_.position(b));
    }

    void measure_reach() {
        reach_.assign(children_.size(), 0.0);
        for (auto joint = static_cast<std::uint32_t>(children_.size()); joint-- > 0;) {
            for (const std::uint32_t child : children_[joint])
                reach_[joint] = std::max(reach_[joint], distance(joint, child) + reach_[child]);
        }
    }

    /// The children that a limb may begin with.
    [[nodiscard]] std::vector<std::uint32_t> roots_below(std::uint32_t joint) const {
        std::vector<std::uint32_t> roots;
        for (const std::uint32_t child : children_[joint]) {
            if (reach_[child] > 0.0 && roots.size() < kMostChildren) roots.push_back(child);
        }
        return roots;
    }

    void find_pairs_below(std::uint32_t joint) {
        const std::vector<std::uint32_t> roots = roots_below(joint);
        for (std::size_t a = 0; a < roots.size(); ++a) {
            for (std::size_t b = a + 1; b < roots.size(); ++b) {
                // All legs of a side may hang on a joint in the middle.
                if (distance(roots[a], roots[b]) < 1e-3 * reach_[roots[a]]) {
                    for (const std::uint32_t left : roots_below(roots[a])) {
                        for (const std::uint32_t right : roots_below(roots[b])) add_pair(left, right);
                    }
                }
                add_pair(roots[a], roots[b]);
            }
        }
    }

    void add_pair(std::uint32_t a, std::uint32_t b) {
        if (chains_.size() < kMostChains) follow(a, b);
    }

    /// The mirror plane between two subtrees.
    struct Mirror {
        glm::dvec3 normal{0.0};
        glm::dvec3 point{0.0};
        [[nodiscard]] glm::dvec3 operator()(const glm::dvec3& p) const {
            return p - 2.0 * glm::dot(p - point, normal) * normal;
        }
    };

    [[nodiscard]] std::uint32_t longest_child(std::uint32_t joint) const {
        std::uint32_t longest = kNone;
        double most = -1.0;
        for (const std::uint32_t child : children_[joint]) {
            const double length = distance(joint, child) + reach_[child];
            if (length <= most) continue;
            most = length;
            longest = child;
        }
        return longest;
    }

    /// Estimates the plane from the first three joints of both, along the longest branches.
    [[nodiscard]] std::optional<Mirror> find_mirror(std::uint32_t a, std::uint32_t b) const {
        glm::dvec3 across(0.0);
        glm::dvec3 between(0.0);
        double joints = 0.0;
        for (int step = 0; step < 3 && a != kNone && b != kNone; ++step) {
            across += rest_.position(a) - rest_.position(b);
            between += 0.5 * (rest_.position(a) + rest_.position(b));
            joints += 1.0;
            a = longest_child(a);
            b = longest_child(b);
        }
        const auto normal = unit(across);
        if (!normal) return std::nullopt;
        return Mirror{*normal, between / joints};
    }

    /// A pair of children that mirror each other; of several the longest.
    [[nodiscard]] std::optional<std::pair<std::uint32_t, std::uint32_t>> next_of(std::uint32_t a, std::uint32_t b,
                                                                                 const Mirror& mirror,
                                                                                 double size) const {
        std::optional<std::pair<std::uint32_t, std::uint32_t>> best;
        double longest = -1.0;
        const auto some = [](const std::vector<std::uint32_t>& all) { return std::min(all.size(), kMostChildren); };
        for (std::size_t i = 0; i < some(children_[a]); ++i) {
            for (std::size_t j = 0; j < some(children_[b]); ++j) {
                const std::uint32_t left = children_[a][i];
                const std::uint32_t right = children_[b][j];
                if (glm::distance(mirror(rest_.position(left)), rest_.position(right)) > 0.06 * size) continue;
                const double length = std::min(distance(a, left) + reach_[left], distance(b, right) + reach_[right]);
                if (length <= longest) continue;
                longest = length;
                best = std::pair(left, right);
            }
        }
        return best;
    }

    [[nodiscard]] bool splits(std::uint32_t joint) const {
        std::size_t branches = 0;
        for (const std::uint32_t child : children_[joint]) branches += reach_[child] > 0.0 ? 1 : 0;
        return branches >= 2 || children_[joint].size() >= 3;
    }

    void follow(std::uint32_t a, std::uint32_t b) {
        const std::optional<Mirror> mirror = find_mirror(a, b);
        if (!mirror) return;
        const double size = std::min(reach_[a], reach_[b]);
        const auto is_mirrored = [&](std::uint32_t left, std::uint32_t right) {
            return glm::distance((*mirror)(rest_.position(left)), rest_.position(right)) <= 0.06 * size;
        };
        if (!is_mirrored(a, b)) return;
        MirroredChains chains;
        chains.across = mirror->normal;
        for (std::optional<std::pair<std::uint32_t, std::uint32_t>> at = std::pair(a, b);
             at && chains.joints[0].size() < kMostJoints; at = next_of(at->first, at->second, *mirror, size)) {
            auto& [left, right] = chains.joints;
            // If joints coincide, the last one carries the bone.
            if (!left.empty() && distance(left.back(), at->first) < 0.01 * size) {
                left.back() = at->first;
                right.back() = at->second;
            } else {
                left.push_back(at->first);
                right.push_back(at->second);
            }
            if (chains.splits_at == 0 && left.size() > 2 && splits(at->first) && splits(at->second))
                chains.splits_at = left.size() - 1;
        }
        if (chains.joints[0].size() >= 3) chains_.push_back(std::move(chains));
    }

    const RestFrames& rest_;
    std::vector<std::vector<std::uint32_t>> children_;
    std::vector<double> reach_;  ///< metres from the joint to its farthest descendant, along the bones
    std::vector<MirroredChains> chains_;
};

}  // namespace

std::vector<std::vector<std::uint32_t>> list_children(const Scene& scene, const std::vector<bool>& chosen) {
    std::vector<std::vector<std::uint32_t>> children(scene.joints.size());
    for (std::uint32_t joint = 0; joint < scene.joints.size(); ++joint) {
        const std::uint32_t parent = scene.joints[joint].parent;
        if (chosen[joint] && parent != kNone) children[parent].push_back(joint);
    }
    return children;
}

std::vector<MirroredChains> find_mirrored_chains(const Scene& scene, const RestFrames& rest,
                                                 const std::vector<bool>& chosen) {
    return ChainFinder(scene, rest, chosen).take();
}

std::uint32_t common_ancestor(const Scene& scene, const RestFrames& rest, const std::vector<std::uint32_t>& joints) {
    if (joints.empty()) return kNone;
    const auto holds_all = [&](std::uint32_t ancestor) {
        return std::all_of(joints.begin(), joints.end(),
                           [&](std::uint32_t joint) { return rest.is_below(joint, ancestor); });
    };
    std::uint32_t joint = scene.joints[joints.front()].parent;
    while (joint != kNone && !holds_all(joint)) joint = scene.joints[joint].parent;
    return joint;
}

}  // namespace bendy::converter
