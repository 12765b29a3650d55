#include "find_humanoid.h"

#include "body_details.h"
#include "mirrored_chains.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <initializer_list>
#include <utility>

namespace bendy::converter {

namespace {

void add_ancestors(const Scene& scene, std::vector<bool>& chosen) {
    for (std::size_t joint = chosen.size(); joint-- > 0;) {
        const std::uint32_t parent = scene.joints[joint].parent;
        if (chosen[joint] && parent != kNone) chosen[parent] = true;
    }
}

}  // namespace

std::vector<bool> find_bound_joints(const Scene& scene) {
    std::vector<bool> bound(scene.joints.size());
    bool has_any = false;
    for (const Mesh& mesh : scene.meshes) {
        for (const std::uint32_t joint : mesh.palette.joints) bound[joint] = has_any = true;
    }
    if (!has_any) {
        bound.assign(bound.size(), true);
        return bound;
    }
    add_ancestors(scene, bound);
    return bound;
}

std::vector<bool> find_moving_joints(const Scene& scene) {
    std::vector<bool> moves(scene.joints.size());
    for (const Mesh& mesh : scene.meshes) {
        if (mesh.influences == 0 && mesh.joint != kNone) moves[mesh.joint] = true;
        for (std::size_t n = 0; n < mesh.bones.size(); ++n) {
            if (mesh.weights[n] > 0.0f) moves[mesh.palette.joints[mesh.bones[n]]] = true;
        }
    }
    if (std::find(moves.begin(), moves.end(), true) == moves.end()) {
        moves.assign(moves.size(), true);
        return moves;
    }
    add_ancestors(scene, moves);
    return moves;
}

namespace {

/// Calls `visit` with each vertex that the joint moves, in the joint's space.
template <class Visit>
void visit_vertices(const Scene& scene, std::uint32_t joint, Visit visit) {
    constexpr float kMost = 0.5f;  // minimum share of a vertex's weights
    for (const Mesh& mesh : scene.meshes) {
        if (mesh.influences == 0) {
            if (mesh.joint != joint) continue;
            for (const glm::vec3& position : mesh.positions) visit(glm::dvec3(position));
            continue;
        }
        const auto& joints = mesh.palette.joints;
        const auto found = std::find(joints.begin(), joints.end(), joint);
        if (found == joints.end()) continue;
        const auto bone = static_cast<std::uint32_t>(found - joints.begin());
        const glm::dmat4 to_joint(mesh.palette.inverse_bind[bone]);
        for (std::size_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
            for (std::size_t n = vertex * mesh.influences; n < (vertex + 1) * mesh.influences; ++n) {
                if (mesh.bones[n] != bone || mesh.weights[n] < kMost) continue;
                visit(glm::dvec3(to_joint * glm::dvec4(glm::dvec3(mesh.positions[vertex]), 1.0)));
                break;
            }
        }
    }
}

/// The sum of the weights with which a joint moves vertices.
double weight_of(const Scene& scene, std::uint32_t joint) {
    double sum = 0.0;
    for (const Mesh& mesh : scene.meshes) {
        if (mesh.influences == 0 && mesh.joint == joint) sum += static_cast<double>(mesh.positions.size());
        for (std::size_t n = 0; n < mesh.bones.size(); ++n)
            sum += mesh.palette.joints[mesh.bones[n]] == joint ? double{mesh.weights[n]} : 0.0;
    }
    return sum;
}

/// The end of the geometry that a joint carries, at rest in model space: as far from the joint as its farthest vertex,
/// towards their middle. For a last bone without a joint at its tip. Nothing if the joint carries no vertices.
std::optional<glm::dvec3> find_mesh_end(const Scene& scene, const RestFrames& rest, std::uint32_t joint) {
    const glm::dvec3 start = rest.position(joint);
    glm::dvec3 sum(0.0);
    visit_vertices(scene, joint, [&](const glm::dvec3& vertex) { sum += rest.place(joint, vertex) - start; });
    const std::optional<glm::dvec3> direction = unit(sum);
    if (!direction) return std::nullopt;
    double farthest = 0.0;
    visit_vertices(scene, joint, [&](const glm::dvec3& vertex) {
        farthest = std::max(farthest, glm::dot(rest.place(joint, vertex) - start, *direction));
    });
    if (!(farthest > 0.0)) return std::nullopt;
    return start + farthest * *direction;
}

struct Candidate {
    std::uint32_t joint = kNone;
    std::uint32_t order =
        0;  ///< lower is better: joints that move vertices first, then sure names, then those near the root
};

class Finder {
public:
    Finder(const Scene& scene, const RestFrames& rest, const std::vector<bool>& chosen)
        : scene_(scene), rest_(rest), children_(list_children(scene, chosen)) {
        names_.resize(scene.joints.size());
        const std::vector<bool> moves = find_moving_joints(scene);
        for (std::uint32_t joint = 0; joint < scene.joints.size(); ++joint) {
            if (!chosen[joint]) continue;
            names_[joint] = read_bone_name(scene.joints[joint].name);
            if (!names_[joint]) continue;
            constexpr std::uint32_t kPerRank = 1u << 24;
            const std::uint32_t order = names_[joint]->rank * kPerRank + std::min(rest.depth(joint), kPerRank - 1);
            list(names_[joint]->part, names_[joint]->side)
                .push_back({joint, order + (moves[joint] ? 0 : 4 * kPerRank)});
        }
        for (auto& of_part : lists_) {
            for (auto& of_side : of_part) {
                std::stable_sort(of_side.begin(), of_side.end(),
                                 [](const Candidate& a, const Candidate& b) { return a.order < b.order; });
                // Rigs have one or a few; more is not a rig, and the search must stay linear.
                if (of_side.size() > kMost) of_side.resize(kMost);
            }
        }
    }

    NamedHumanoid find() {
        for (const BodySide side : {BodySide::left, BodySide::right}) {
            find_arm(side);
            find_leg(side);
        }
        find_blocks({BodyPart::upper_arm, BodyPart::arm}, HumanBone::left_upper_arm);
        find_blocks({BodyPart::upper_leg, BodyPart::leg}, HumanBone::left_upper_leg);
        find_trunk();
        return found_;
    }

private:
    static constexpr std::size_t kMost = 8;
    using Candidates = std::vector<Candidate>;

    Candidates& list(BodyPart part, BodySide side) {
        return lists_[static_cast<std::size_t>(part)][static_cast<std::size_t>(side)];
    }

    [[nodiscard]] bool is_below(std::uint32_t joint, std::uint32_t ancestor) const {
        return ancestor == kNone || rest_.is_below(joint, ancestor);
    }

    /// The best joint of the part below `ancestor`; kNone: anywhere.
    std::uint32_t pick(BodyPart part, BodySide side, std::uint32_t ancestor = kNone) {
        for (const Candidate& candidate : list(part, side)) {
            if (is_below(candidate.joint, ancestor)) return candidate.joint;
        }
        return kNone;
    }

    /// The best pair of an upper and a lower bone, trying these lists in turn.
    bool pick_pair(BodySide side, std::initializer_list<std::pair<BodyPart, BodyPart>> lists, std::uint32_t& upper,
                   std::uint32_t& lower) {
        for (const auto& [upper_part, lower_part] : lists) {
            for (const Candidate& candidate : list(upper_part, side)) {
                upper = candidate.joint;
                lower = pick(lower_part, side, upper);
                if (lower != kNone) return true;
            }
        }
        upper = lower = kNone;
        return false;
    }

    [[nodiscard]] HumanBone of_side(HumanBone left, BodySide side) const {
        return side == BodySide::left ? left : mirrored(left);
    }

    /// The joint with that name below the limb's lower bone, or else its branch that stands for the hand, or its
    /// farthest child; kNone if the limb ends in a joint beside it.
    std::uint32_t find_end(BodyPart part, BodySide side, std::uint32_t lower, std::size_t loose) {
        const std::uint32_t end = pick(part, side, lower);
        const std::uint32_t other = pick(part, side);
        if (end != kNone && (end == other || !stands_for(other, end))) return end;
        found_.loose_ends[loose] = other;
        if (other != kNone) return kNone;
        const bool is_split = part == BodyPart::hand && children_[lower].size() > 2;
        if (is_split) found_.has_split_hands = true;
        const std::uint32_t branch = is_split ? find_split_hand(scene_, rest_, lower) : kNone;
        return branch != kNone ? branch : farthest_child(lower);
    }

    /// Whether a joint beside a limb is its real end: it rests where the one in the limb does, and moves more.
    [[nodiscard]] bool stands_for(std::uint32_t other, std::uint32_t end) const {
        const double bone = glm::distance(rest_.position(scene_.joints[end].parent), rest_.position(end));
        return glm::distance(rest_.position(other), rest_.position(end)) < 0.01 * bone &&
               weight_of(scene_, other) > weight_of(scene_, end);
    }

    [[nodiscard]] std::uint32_t farthest_child(std::uint32_t joint) const {
        std::uint32_t farthest = kNone;
        double most = 0.0;
        for (const std::uint32_t child : children_[joint]) {
            const double distance = glm::distance(rest_.position(joint), rest_.position(child));
            if (!(distance > most)) continue;
            most = distance;
            farthest = child;
        }
        return farthest;
    }

    void find_arm(BodySide side) {
        std::uint32_t upper = kNone;
        std::uint32_t lower = kNone;
        if (!pick_pair(side,
                       {{BodyPart::upper_arm, BodyPart::lower_arm},
                        {BodyPart::arm, BodyPart::lower_arm},
                        {BodyPart::upper_arm, BodyPart::arm},
                        {BodyPart::shoulder, BodyPart::lower_arm}},
                       upper, lower)) {
            return;
        }
        // A rig may have both `LeftCollar` and `LeftShoulder`: the one below is the upper arm.
        for (const Candidate& candidate : list(BodyPart::shoulder, side)) {
            if (is_named(upper, {BodyPart::shoulder}) && is_below(candidate.joint, upper) &&
                is_below(lower, candidate.joint))
                upper = candidate.joint;
        }
        const std::uint32_t hand = find_end(BodyPart::hand, side, lower, side == BodySide::left ? 0 : 1);
        found_.bones[of_side(HumanBone::left_upper_arm, side)] = upper;
        found_.bones[of_side(HumanBone::left_lower_arm, side)] = lower;
        found_.bones[of_side(HumanBone::left_hand, side)] = hand;
        found_.has_front_legs = found_.has_front_legs || names_[upper]->is_front_leg;
        const std::uint32_t shoulder = pick(BodyPart::shoulder, side);
        if (shoulder != kNone && rest_.is_below(upper, shoulder))
            found_.bones[of_side(HumanBone::left_shoulder, side)] = shoulder;
        if (hand == kNone) return;
        if (names_[hand] && names_[hand]->rank != 0 && children_[lower].size() > 1) found_.has_split_hands = true;
        found_.bones[of_side(HumanBone::left_thumb_metacarpal, side)] = pick(BodyPart::thumb, side, hand);
    }

    void find_leg(BodySide side) {
        std::uint32_t upper = kNone;
        std::uint32_t lower = kNone;
        if (!pick_pair(side,
                       {{BodyPart::upper_leg, BodyPart::lower_leg},
                        {BodyPart::upper_leg, BodyPart::leg},
                        {BodyPart::leg, BodyPart::lower_leg}},
                       upper, lower)) {
            return;
        }
        // CMU's skeletons have `LHipJoint` above `LeftHip`: the thigh is the one nearest the knee.
        for (const Candidate& candidate : list(BodyPart::upper_leg, side)) {
            if (names_[upper]->rank != 0 && is_below(candidate.joint, upper) && is_below(lower, candidate.joint))
                upper = candidate.joint;
        }
        const std::uint32_t foot = find_end(BodyPart::foot, side, lower, side == BodySide::left ? 2 : 3);
        found_.bones[of_side(HumanBone::left_upper_leg, side)] = upper;
        found_.bones[of_side(HumanBone::left_lower_leg, side)] = lower;
        found_.bones[of_side(HumanBone::left_foot, side)] = foot;
        if (foot != kNone) found_.bones[of_side(HumanBone::left_toes, side)] = pick(BodyPart::toes, side, foot);
    }

    /// Limbs of one joint, as toys have them: a pair of clear names of which neither side has two bones.
    void find_blocks(std::initializer_list<BodyPart> parts, HumanBone left) {
        if (found_.bones.has(left) || found_.bones.has(mirrored(left))) return;
        for (const BodyPart part : parts) {
            const std::uint32_t on_left = pick(part, BodySide::left);
            const std::uint32_t on_right = pick(part, BodySide::right);
            const auto is_clear = [&](std::uint32_t joint) { return joint != kNone && names_[joint]->rank == 0; };
            if (!is_clear(on_left) || !is_clear(on_right)) continue;
            found_.bones[left] = on_left;
            found_.bones[mirrored(left)] = on_right;
            found_.has_front_legs = found_.has_front_legs || names_[on_left]->is_front_leg;
            return;
        }
    }

    /// The lowest common ancestor, kNone if there is none.
    [[nodiscard]] std::uint32_t common_ancestor(HumanBone a, HumanBone b) const {
        if (!found_.bones.has(a) || !found_.bones.has(b)) return kNone;
        std::uint32_t joint = scene_.joints[found_.bones[a]].parent;
        while (joint != kNone && !rest_.is_below(found_.bones[b], joint)) joint = scene_.joints[joint].parent;
        return joint;
    }

    [[nodiscard]] bool is_named(std::uint32_t joint, std::initializer_list<BodyPart> parts) const {
        return joint != kNone && names_[joint] &&
               std::find(parts.begin(), parts.end(), names_[joint]->part) != parts.end();
    }

    void find_trunk() {
        Humanoid& bones = found_.bones;
        const std::uint32_t legs = common_ancestor(HumanBone::left_upper_leg, HumanBone::right_upper_leg);
        bones[HumanBone::hips] = pick(BodyPart::hips, BodySide::none);
        for (const Candidate& candidate : list(BodyPart::hips, BodySide::none)) {
            if (legs != kNone && (candidate.joint == legs || rest_.is_below(legs, candidate.joint))) {
                bones[HumanBone::hips] = candidate.joint;
                break;
            }
        }
        // Rigify names the hips `spine`: the joint that carries the legs.
        if (!bones.has(HumanBone::hips) && is_named(legs, {BodyPart::spine})) bones[HumanBone::hips] = legs;
        find_head();
        // Some skeletons end in a joint `neck`, which turns the head.
        if (!bones.has(HumanBone::head)) bones[HumanBone::head] = pick(BodyPart::neck, BodySide::none);
        if (!bones.has(HumanBone::head)) return;
        const std::vector<std::uint32_t> path = path_from_hips();
        const auto spine = std::find_if(path.begin(), path.end(), [&](std::uint32_t joint) {
            return joint != bones[HumanBone::hips] && is_named(joint, {BodyPart::spine, BodyPart::chest});
        });
        if (spine != path.end() && *spine != bones[HumanBone::neck] && *spine != bones[HumanBone::head])
            bones[HumanBone::spine] = *spine;
    }

    [[nodiscard]] std::vector<std::uint32_t> path_from_hips() const {
        const std::uint32_t head = found_.bones[HumanBone::head];
        const std::uint32_t hips = found_.bones[HumanBone::hips];
        std::vector<std::uint32_t> path;
        for (std::uint32_t joint = head; joint != kNone; joint = scene_.joints[joint].parent) {
            path.push_back(joint);
            if (joint == hips) break;
        }
        std::reverse(path.begin(), path.end());
        return path;
    }

    void find_head() {
        Humanoid& bones = found_.bones;
        bones[HumanBone::head] = pick(BodyPart::head, BodySide::none);
        if (bones.has(HumanBone::head)) {
            for (const Candidate& candidate : list(BodyPart::neck, BodySide::none)) {
                if (!rest_.is_below(bones[HumanBone::head], candidate.joint)) continue;
                bones[HumanBone::neck] = candidate.joint;
                break;
            }
            return;
        }
        // Rigify numbers its spine up to the head: from where the arms leave, the joints are neck and head.
        const std::uint32_t arms = common_ancestor(HumanBone::left_upper_arm, HumanBone::right_upper_arm);
        if (!is_named(arms, {BodyPart::spine, BodyPart::chest})) return;
        std::uint32_t last = arms;
        for (bool goes_on = true; goes_on;) {
            goes_on = false;
            for (const std::uint32_t child : children_[last]) {
                if (!is_named(child, {BodyPart::spine})) continue;
                if (last == arms) bones[HumanBone::neck] = child;
                last = child;
                goes_on = true;
                break;
            }
        }
        if (last == arms) return;
        bones[HumanBone::head] = last;
        if (bones[HumanBone::neck] == last) bones[HumanBone::neck] = kNone;
    }

    const Scene& scene_;
    const RestFrames& rest_;
    std::vector<std::optional<BoneName>> names_;
    std::vector<std::vector<std::uint32_t>> children_;         ///< chosen joints only
    std::array<std::array<Candidates, 3>, kBodyParts> lists_;  ///< by part and side
    NamedHumanoid found_;
};

}  // namespace

std::optional<glm::dvec3> end_of(const NamedHumanoid& found, const RestFrames& rest, Limb limb) {
    const LimbBones bones = bones_of(limb);
    const auto number = static_cast<std::size_t>(limb);
    if (found.bones.has(bones.end)) return rest.position(found.bones[bones.end]);
    const std::uint32_t loose = found.loose_ends[number];
    if (loose == kNone || !found.bones.has(bones.upper) || !found.bones.has(bones.lower))
        return found.mesh_ends[number];
    const glm::dvec3 middle = rest.position(found.bones[bones.lower]);
    const double upper = glm::distance(rest.position(found.bones[bones.upper]), middle);
    const double lower = glm::distance(middle, rest.position(loose));
    const bool is_its_end = lower > 0.3 * upper && lower < 3.0 * upper;
    return is_its_end ? std::optional(rest.position(loose)) : found.mesh_ends[number];
}

void find_mesh_ends(const Scene& scene, const RestFrames& rest, NamedHumanoid& found) {
    for (std::size_t limb = 0; limb < kLimbs; ++limb) {
        const LimbBones bones = bones_of(static_cast<Limb>(limb));
        const std::uint32_t last = found.bones[found.bones.has(bones.lower) ? bones.lower : bones.upper];
        if (last == kNone || end_of(found, rest, static_cast<Limb>(limb))) continue;
        found.mesh_ends[limb] = find_mesh_end(scene, rest, last);
    }
}

NamedHumanoid find_humanoid(const Scene& scene, const RestFrames& rest, const std::vector<bool>& chosen) {
    return Finder(scene, rest, chosen).find();
}

}  // namespace bendy::converter
