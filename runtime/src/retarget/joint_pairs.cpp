#include "joint_pairs.h"

#include "math/rotation.h"

#include <bendy/runtime/binding.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

namespace bendy {
namespace {

/// A bone, from its joint to the next. The last one of a finger has no end, and is aligned as the one before.
struct Bone {
    Role joint;
    Role end;
};

constexpr Bone kBones[] = {
    {Role::left_thumb_metacarpal, Role::left_thumb_proximal},
    {Role::left_thumb_proximal, Role::left_thumb_distal},
    {Role::left_index_proximal, Role::left_index_intermediate},
    {Role::left_index_intermediate, Role::left_index_distal},
    {Role::left_middle_proximal, Role::left_middle_intermediate},
    {Role::left_middle_intermediate, Role::left_middle_distal},
    {Role::left_ring_proximal, Role::left_ring_intermediate},
    {Role::left_ring_intermediate, Role::left_ring_distal},
    {Role::left_little_proximal, Role::left_little_intermediate},
    {Role::left_little_intermediate, Role::left_little_distal},
    {Role::right_thumb_metacarpal, Role::right_thumb_proximal},
    {Role::right_thumb_proximal, Role::right_thumb_distal},
    {Role::right_index_proximal, Role::right_index_intermediate},
    {Role::right_index_intermediate, Role::right_index_distal},
    {Role::right_middle_proximal, Role::right_middle_intermediate},
    {Role::right_middle_intermediate, Role::right_middle_distal},
    {Role::right_ring_proximal, Role::right_ring_intermediate},
    {Role::right_ring_intermediate, Role::right_ring_distal},
    {Role::right_little_proximal, Role::right_little_intermediate},
    {Role::right_little_intermediate, Role::right_little_distal},
};

/// Ends of fingers, which are aligned as the bone above.
constexpr Bone kEnds[] = {
    {Role::left_thumb_distal, Role::left_thumb_proximal},
    {Role::left_index_distal, Role::left_index_intermediate},
    {Role::left_middle_distal, Role::left_middle_intermediate},
    {Role::left_ring_distal, Role::left_ring_intermediate},
    {Role::left_little_distal, Role::left_little_intermediate},
    {Role::right_thumb_distal, Role::right_thumb_proximal},
    {Role::right_index_distal, Role::right_index_intermediate},
    {Role::right_middle_distal, Role::right_middle_intermediate},
    {Role::right_ring_distal, Role::right_ring_intermediate},
    {Role::right_little_distal, Role::right_little_intermediate},
};

struct Hand {
    Role hand, arm;
    std::array<Role, 3> fingers;  ///< one of which says where the hand points
};

constexpr Hand kHands[] = {
    {Role::left_hand,
     Role::left_lower_arm,
     {Role::left_middle_proximal, Role::left_index_proximal, Role::left_ring_proximal}},
    {Role::right_hand,
     Role::right_lower_arm,
     {Role::right_middle_proximal, Role::right_index_proximal, Role::right_ring_proximal}},
};

/// How far bones of standing bodies differ between rigs of different makers, as cosines: the 95th percentile over pairs
/// of 44 bodies, in degrees; of the trunk as a whole, the most over pairs of 52. Bones that differ by more do not mean
/// the same: one of the bodies does not stand as people do.
constexpr double kCollarbone = 0.67;  // 48
constexpr double kSpine = 0.91;       // 25
constexpr double kTrunk = 0.978;      // 12
constexpr double kNeck = 0.85;        // 32
constexpr double kFoot = 0.80;        // 37
constexpr double kAlways = 2.0;       // more than any cosine

bool has_same_rest(const Joint& a, const Joint& b) {
    return a.rest.rotation == b.rest.rotation && a.rest.translation == b.rest.translation &&
           a.rest.scale == b.rest.scale && a.shear == b.shear;
}

/// Returns true if the two have the same joints, whatever their names.
bool is_same_skeleton(const Model& a, const Model& b) {
    return std::equal(a.joints().begin(), a.joints().end(), b.joints().begin(), b.joints().end(),
                      [](const Joint& x, const Joint& y) { return x.parent == y.parent && has_same_rest(x, y); });
}

class Pairs {
public:
    Pairs(const Body& source, const Body& target, const glm::dquat& turn)
        : source_(source),
          target_(target),
          turn_(turn),
          pairs_(target.model().joints().size()),
          is_used_(source.model().joints().size()) {}

    void pair_single(Role role) { pair(target_.joint(role), source_.joint(role)); }

    /// Spreads the turns of a column of joints over another one. The column begins below `base` and ends before `tip`,
    /// joints of the source that turn on their own.
    void pair_column(const std::vector<std::uint32_t>& from, const std::vector<std::uint32_t>& to,
                     std::uint32_t tip = kNone) {
        std::vector<std::uint32_t> nodes = from;
        if (tip != kNone) nodes.push_back(tip);
        if (nodes.empty() || to.empty()) return;
        const std::uint32_t base = source_.model().joints()[nodes.front()].parent;
        nodes.insert(nodes.begin(), base == kNone ? nodes.front() : base);
        const std::size_t steps = to.size() + (tip == kNone ? 0 : 1);
        for (std::size_t k = 1; k <= to.size(); ++k) {
            const std::size_t along = k * (nodes.size() - 1);
            const std::size_t node = along / steps;
            const double share = static_cast<double>(along % steps) / static_cast<double>(steps);
            pair(to[k - 1], nodes[node], share > 0.0 ? nodes[node + 1] : kNone, share);
        }
    }

    /// Aligns a column of joints that are paired if one of its bones differs by more than those of standing bodies do.
    /// \param from_end, to_end  what the last joint of the column points to
    /// \param usual, whole  cosines: of one bone, and of the way from the first joint to the end
    void align_column(std::vector<std::uint32_t> from, std::uint32_t from_end, std::vector<std::uint32_t> to,
                      std::uint32_t to_end, double usual, double whole) {
        if (from.empty() || to.empty() || from_end == kNone || to_end == kNone) return;
        from.push_back(from_end);
        to.push_back(to_end);
        const auto way_of_source = [&](std::uint32_t joint) -> glm::dvec3 {
            const auto at = std::find(from.begin(), from.end(), joint);
            // A joint that is not in the column carries it: the column's first bone stands for it. A bone without
            // length points where the one before it does.
            auto first = at == from.end() ? from.begin() : at + 1 == from.end() ? at - 1 : at;
            while (first != from.begin() && source_.place(*(first + 1)) == source_.place(*first)) --first;
            return source_.place(*(first + 1)) - source_.place(*first);
        };
        std::vector<PairedBone> bones;
        for (std::size_t k = 0; k + 1 < to.size(); ++k) {
            const JointPair& pair = pairs_[to[k]];
            if (pair.a == kNone) continue;
            glm::dvec3 way = way_of_source(pair.a);
            if (pair.b != kNone) way = (1.0 - pair.share) * way + pair.share * way_of_source(pair.b);
            bones.push_back({to[k], way, target_.place(to[k + 1]) - target_.place(to[k])});
        }
        const PairedBone column{kNone, source_.place(from_end) - source_.place(from.front()),
                                target_.place(to_end) - target_.place(to.front())};
        align_if_unlike(bones, stand_anyhow_ || is_unlike(column, whole) ? kAlways : usual);
    }

    /// Pairs the joints of a limb from hip or shoulder outwards, and those that carry it from there inwards.
    void pair_limb(const Limb& from, const Limb& to) {
        const std::size_t carriers = std::min(from.girdle.size(), to.girdle.size());
        for (std::size_t k = 1; k <= carriers; ++k)
            pair(to.girdle[to.girdle.size() - k], from.girdle[from.girdle.size() - k]);
        for (std::size_t k = 0; k < std::min(from.joints.size(), to.joints.size()); ++k)
            pair(to.joints[k], from.joints[k]);
    }

    /// Where one of the two has a foot already, the other's joint is held as a foot too.
    void align_limb(const Limb& from, const Limb& to) {
        const std::size_t joints = std::min(from.joints.size(), to.joints.size());
        if (joints == 0) return;
        const std::size_t foot = std::min({from.foot, to.foot, joints - 1});
        for (std::size_t k = 0; k < foot; ++k) {
            align(to.joints[k], source_.place(from.joints[k + 1]) - source_.place(from.joints[k]),
                  target_.place(to.joints[k + 1]) - target_.place(to.joints[k]));
        }
        if (foot < std::min(from.foot, to.foot)) {
            // Without a foot or a hand nobody knows where the last bone points.
            if (foot > 0) pairs_[to.joints[foot]].align = pairs_[to.joints[foot - 1]].align;
            return;
        }
        if (!from.is_leg) return;
        align(to.joints[foot], heading_of(source_, from, foot), heading_of(target_, to, foot));
        for (std::size_t k = foot + 1; k < to.joints.size(); ++k) {
            if (is_paired(to.joints[k])) pairs_[to.joints[k]].align = pairs_[to.joints[k - 1]].align;
        }
    }

    void align_bone(const Bone& bone) {
        const std::uint32_t joint = target_.joint(bone.joint);
        if (!is_paired(joint)) return;
        const auto way = [&](const Body& body) { return way_of(body, bone.joint, bone.end); };
        align(joint, way(source_), way(target_));
    }

    /// In a moment of a clip hips tilt; in a body that is made to stand the line of the hip joints is level.
    void align_hips() {
        if (!stand_anyhow_ || !source_.has_hip_joints() || !target_.has_hip_joints()) return;
        const auto line = [](const Body& body) {
            return body.place(body.limbs()[0].upper()) - body.place(body.limbs()[1].upper());
        };
        if (is_paired(target_.joint(Role::hips))) align(target_.joint(Role::hips), line(source_), line(target_));
    }

    /// Bones of a human that are not limbs, if one of them differs by more than those of standing bodies do.
    void align_if_unlike(std::initializer_list<Bone> bones, double usual) {
        std::vector<PairedBone> paired;
        for (const Bone& bone : bones) {
            const auto source = way_of(source_, bone.joint, bone.end);
            const auto target = way_of(target_, bone.joint, bone.end);
            if (source && target && is_paired(target_.joint(bone.joint)))
                paired.push_back({target_.joint(bone.joint), *source, *target});
        }
        align_if_unlike(paired, usual);
    }

    void align_as(Role joint, Role above) {
        if (is_paired(target_.joint(joint)) && is_paired(target_.joint(above)))
            pairs_[target_.joint(joint)].align = pairs_[target_.joint(above)].align;
    }

    void align_hand(const Hand& hand) {
        align_as(hand.hand, hand.arm);
        for (const Role finger : hand.fingers) {
            if (source_.joint(finger) == kNone || target_.joint(finger) == kNone) continue;
            return align_bone({hand.hand, finger});
        }
    }

    /// Chains of the same number of joints.
    void align_chain(const std::vector<std::uint32_t>& from, const std::vector<std::uint32_t>& to) {
        if (from.size() != to.size()) return;
        for (std::size_t k = 0; k < to.size(); ++k) {
            if (k + 1 < to.size()) {
                align(to[k], source_.place(from[k + 1]) - source_.place(from[k]),
                      target_.place(to[k + 1]) - target_.place(to[k]));
            } else if (k > 0) {
                pairs_[to[k]].align = pairs_[to[k - 1]].align;
            }
        }
    }

    /// Pairs joints without a role by their names, or by their numbers if the skeletons are the same.
    void pair_props() {
        const Model& source = source_.model();
        const Model& target = target_.model();
        std::vector<std::uint32_t> by_name(pairs_.size(), kNone);
        if (is_same_skeleton(source, target)) {
            for (std::uint32_t joint = 0; joint < by_name.size(); ++joint) by_name[joint] = joint;
        } else {
            const Binding names(source, target);
            for (std::uint32_t joint = 0; joint < names.joints().size(); ++joint) {
                if (names.joints()[joint] != kNone) by_name[names.joints()[joint]] = joint;
            }
        }
        for (std::uint32_t joint = 0; joint < by_name.size(); ++joint) {  // parents come first
            const std::uint32_t from = by_name[joint];
            if (from == kNone || is_paired(joint) || is_used_[from] || source_.has_role(from)) continue;
            if (carrier(target, joint, [&](std::uint32_t above) { return pairs_[above].a; }) !=
                carrier(source, from, [&](std::uint32_t above) { return is_used_[above] ? above : kNone; })) {
                continue;
            }
            pair(joint, from);
            pairs_[joint].is_prop = true;
        }
        align_props();
    }

    [[nodiscard]] std::vector<JointPair> take() { return std::move(pairs_); }

private:
    [[nodiscard]] bool is_paired(std::uint32_t joint) const { return joint != kNone && pairs_[joint].a != kNone; }

    void pair(std::uint32_t to, std::uint32_t a, std::uint32_t b = kNone, double share = 0.0) {
        if (to == kNone || a == kNone || is_paired(to)) return;
        pairs_[to].a = a;
        pairs_[to].b = b;
        pairs_[to].share = share;
        is_used_[a] = true;
    }

    /// A joint of the target, and where the bones of both point.
    struct PairedBone {
        std::uint32_t joint = kNone;
        glm::dvec3 source{0.0}, target{0.0};
    };

    [[nodiscard]] bool is_unlike(const PairedBone& bone, double usual) const {
        return glm::dot(turn_ * bone.source, bone.target) < usual * glm::length(bone.source) * glm::length(bone.target);
    }

    /// Aligns all if the directions of one are farther apart than the cosine says.
    void align_if_unlike(const std::vector<PairedBone>& bones, double usual) {
        const bool are_unlike =
            std::any_of(bones.begin(), bones.end(), [&](const PairedBone& bone) { return is_unlike(bone, usual); });
        if (!are_unlike) return;
        for (const PairedBone& bone : bones) align(bone.joint, bone.source, bone.target);
    }

    /// Feet are flat on the ground at rest, so usually only their headings differ.
    static std::optional<glm::dvec3> heading_of(const Body& body, const Limb& limb, std::size_t foot) {
        if (foot + 1 >= limb.joints.size()) return std::nullopt;
        const glm::dvec3 way = body.place(limb.joints.back()) - body.place(limb.joints[foot]);
        const glm::dvec3 flat = way - body.up() * glm::dot(body.up(), way);
        constexpr double kSteep = 0.2;  // of its length
        if (!(glm::length(flat) > kSteep * glm::length(way))) return std::nullopt;
        return flat;
    }

    static std::optional<glm::dvec3> way_of(const Body& body, Role from, Role to) {
        if (body.joint(from) == kNone || body.joint(to) == kNone) return std::nullopt;
        return body.place(body.joint(to)) - body.place(body.joint(from));
    }

    void align(std::uint32_t joint, const std::optional<glm::dvec3>& source, const std::optional<glm::dvec3>& target) {
        if (!source || !target) return;
        const glm::dquat turn = between(*target, turn_ * *source);
        constexpr double kSame = 1.0 - 1e-14;  // rounding
        if (turn.w < kSame) pairs_[joint].align = turn;
    }

    /// Returns what `of` says of the nearest joint above that it knows; kNone if there is none.
    template <class Of>
    static std::uint32_t carrier(const Model& model, std::uint32_t joint, const Of& of) {
        for (joint = model.parents()[joint]; joint != kNone; joint = model.parents()[joint]) {
            if (of(joint) != kNone) return of(joint);
        }
        return kNone;
    }

    /// A prop is held as its carrier is.
    void align_props() {
        const auto parents = target_.model().parents();
        for (std::uint32_t joint = 0; joint < pairs_.size(); ++joint) {
            if (!pairs_[joint].is_prop) continue;
            std::uint32_t above = parents[joint];
            while (above != kNone && !is_paired(above)) above = parents[above];
            if (above != kNone) pairs_[joint].align = pairs_[above].align;
        }
    }

    const Body& source_;
    const Body& target_;
    glm::dquat turn_;
    bool stand_anyhow_ = source_.stands_anyhow() || target_.stands_anyhow();
    std::vector<JointPair> pairs_;
    std::vector<bool> is_used_;
};

constexpr Role kChains[] = {Role::tail, Role::left_wing, Role::right_wing};

std::vector<std::uint32_t> column(const Body& body, std::initializer_list<Role> singles, Role chain) {
    std::vector<std::uint32_t> joints = body.joints(singles);
    const std::vector<std::uint32_t> others = body.chain(chain);
    joints.insert(joints.end(), others.begin(), others.end());
    return joints;
}

}  // namespace

std::vector<JointPair> pair_joints(const Body& source, const Body& target, const glm::dquat& turn,
                                   RestPoses rest_poses) {
    Pairs pairs(source, target, turn);
    const auto spine = [](const Body& body) {
        return column(body, {Role::spine, Role::chest, Role::upper_chest}, Role::spine_chain);
    };
    const auto neck = [](const Body& body) { return column(body, {Role::neck}, Role::neck_chain); };
    const bool are_alike = rest_poses == RestPoses::alike;
    if (!are_alike) {
        pairs.pair_column(spine(source), spine(target));
        pairs.pair_column(neck(source), neck(target), source.joint(Role::head));
    }
    for (auto role = static_cast<std::uint16_t>(Role::hips); role < static_cast<std::uint16_t>(kFirstChainRole); ++role)
        pairs.pair_single(static_cast<Role>(role));
    for (std::size_t limb = 0; limb < target.limbs().size(); ++limb)
        pairs.pair_limb(source.limbs()[limb], target.limbs()[limb]);
    for (const Role role : kChains) pairs.pair_column(source.chain(role), target.chain(role));
    if (!are_alike) {
        for (std::size_t limb = 0; limb < target.limbs().size(); ++limb)
            pairs.align_limb(source.limbs()[limb], target.limbs()[limb]);
        if (target.kind() == BodyKind::human) {
            const auto end_of_spine = [&](const Body& body) {
                const std::vector<std::uint32_t> above = neck(body);
                return above.empty() ? body.joint(Role::head) : above.front();
            };
            pairs.align_hips();
            pairs.align_column(spine(source), end_of_spine(source), spine(target), end_of_spine(target), kSpine,
                               kTrunk);
            pairs.align_column(neck(source), source.joint(Role::head), neck(target), target.joint(Role::head), kNeck,
                               kNeck);
            pairs.align_if_unlike(
                {{Role::left_shoulder, Role::left_upper_arm}, {Role::right_shoulder, Role::right_upper_arm}},
                kCollarbone);
            pairs.align_if_unlike({{Role::left_foot, Role::left_toes}, {Role::right_foot, Role::right_toes}}, kFoot);
            pairs.align_as(Role::left_toes, Role::left_foot);
            pairs.align_as(Role::right_toes, Role::right_foot);
        }
        for (const Bone& bone : kBones) pairs.align_bone(bone);
        for (const Hand& hand : kHands) pairs.align_hand(hand);
        for (const Bone& end : kEnds) pairs.align_as(end.joint, end.end);
        for (const Role role : kChains) pairs.align_chain(source.chain(role), target.chain(role));
    }
    pairs.pair_props();
    return pairs.take();
}

}  // namespace bendy
