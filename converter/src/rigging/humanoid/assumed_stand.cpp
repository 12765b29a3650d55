#include "assumed_stand.h"

#include "clip_frames.h"
#include "complete_human.h"
#include "limb_chains.h"
#include "scene/rest_frames.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace bendy::converter {
namespace {

using Bone = HumanBone;

constexpr glm::dvec3 kLeft{1.0, 0.0, 0.0}, kUp{0.0, 1.0, 0.0}, kFront{0.0, 0.0, 1.0};
constexpr glm::dvec3 kNeckStands{0.0, 0.97, 0.24};   // what is usual: between makers it differs by 30 degrees
constexpr glm::dvec3 kFootStands{0.0, -0.57, 0.82};  // ankles are above the toes
constexpr glm::dvec3 kCrownStands{0.0, 0.99, 0.15};
constexpr Rotation kNoTurn{1.0, 0.0, 0.0, 0.0};

/// A direction of a joint, and where it points in a body that stands.
struct Aim {
    std::optional<glm::dvec3> own;  ///< in the joint's axes
    glm::dvec3 stands{0.0};
};

/// Where a joint points, and then, as far as that leaves it open, another direction.
struct Aims {
    Aim along, side;
};

/// Two bones that bend about one axis.
struct Hinge {
    Bone upper, lower, end;  ///< of the left side; end: kTip where no bone of the humanoid follows
    glm::dvec3 stands;       ///< the axis on the left
};
constexpr double kLeastBend = 0.015;  // 1 less the cosine: 10 degrees
constexpr Bone kTip = Bone::none;
constexpr std::array kHinges{Hinge{Bone::left_upper_arm, Bone::left_lower_arm, Bone::left_hand, -kUp},
                             Hinge{Bone::left_upper_leg, Bone::left_lower_leg, Bone::left_foot, kLeft},
                             Hinge{Bone::left_foot, Bone::left_toes, kTip, -kLeft}};

/// The smallest rotation from one unit vector to another.
Rotation swing(const glm::dvec3& from, const glm::dvec3& to) {
    const double cosine = glm::dot(from, to);
    if (cosine > -0.9999) return glm::normalize(Rotation(1.0 + cosine, glm::cross(from, to)));
    const glm::dvec3 any = std::abs(from.x) < 0.7 ? kLeft : kUp;
    return {0.0, *unit_across(any, from)};
}

/// The rotation from one pair of directions to another: exact for the first of them.
std::optional<Rotation> turn_between(const Aims& aims) {
    const auto axes = [](const glm::dvec3& along, const glm::dvec3& side) -> std::optional<Rotation> {
        const auto across = unit_across(side, along);
        if (!across) return std::nullopt;
        return rotation_of_axes(glm::dmat3(along, *across, glm::cross(along, *across)));
    };
    const auto from = axes(*aims.along.own, *aims.side.own);
    const auto to = axes(aims.along.stands, aims.side.stands);
    if (!from || !to) return std::nullopt;
    return *to * glm::conjugate(*from);
}

class StandAssumer {
public:
    StandAssumer(const Scene& scene, const Humanoid& bones, const std::vector<Transform>& base,
                 const std::optional<glm::dvec3>& up)
        : scene_(scene), bones_(bones), base_(scene, base), up_(up), aims_(scene.joints.size()) {
        most_bent_.fill(kLeastBend);
    }

    std::vector<Transform> assume() {
        find_hinges();
        aim_trunk();
        for (const bool right : {false, true}) {
            aim_leg(right);
            aim_arm(right);
        }
        return turned();
    }

private:
    static glm::dvec3 mirrored_way(const glm::dvec3& way) { return {-way.x, way.y, way.z}; }
    [[nodiscard]] std::uint32_t joint(Bone left, bool right) const { return bones_[right ? mirrored(left) : left]; }

    [[nodiscard]] std::optional<glm::dvec3> way(std::uint32_t from, std::uint32_t to) const {
        return from == kNone || to == kNone ? std::nullopt : base_.direction(from, to);
    }
    [[nodiscard]] std::optional<glm::dvec3> in_axes_of(std::uint32_t joint, std::optional<glm::dvec3> way) const {
        if (!way) return std::nullopt;
        return glm::conjugate(base_.turn(joint)) * *way;
    }
    /// The child that is farthest from a joint: the end of a bone that is the last to have a name.
    [[nodiscard]] std::uint32_t tip_of(std::uint32_t joint) const {
        std::uint32_t tip = kNone;
        for (std::uint32_t child = 0; joint != kNone && child < scene_.joints.size(); ++child) {
            if (scene_.joints[child].parent != joint) continue;
            const auto far = [&](std::uint32_t one) {
                return glm::distance(base_.position(one), base_.position(joint));
            };
            if (tip == kNone || far(child) > far(tip)) tip = child;
        }
        return tip;
    }
    void aim(std::uint32_t joint, std::optional<glm::dvec3> along, const glm::dvec3& stands) {
        if (joint != kNone && along) aims_[joint].along = {in_axes_of(joint, along), glm::normalize(stands)};
    }
    void aim_side(std::uint32_t joint, std::optional<glm::dvec3> side, const glm::dvec3& stands) {
        if (joint != kNone && side) aims_[joint].side = {in_axes_of(joint, side), stands};
    }

    // --- what bends

    void find_hinges() {
        find_hinges_in(base_);
        visit_frames(scene_, [&](const std::vector<Transform>& locals) { find_hinges_in(RestFrames(scene_, locals)); });
    }

    void find_hinges_in(const RestFrames& pose) {
        for (std::size_t number = 0; number < kHinges.size(); ++number) {
            for (const bool right : {false, true})
                find_hinge_in(pose, kHinges[number], right, most_bent_[2 * number + (right ? 1 : 0)]);
        }
    }

    /// \param most  of the poses so far, 1 less the cosine of the angle by which the joint bends
    void find_hinge_in(const RestFrames& pose, const Hinge& hinge, bool right, double& most) {
        const std::uint32_t upper = joint(hinge.upper, right);
        const std::uint32_t lower = joint(hinge.lower, right);
        const std::uint32_t end = hinge.end == kTip ? tip_of(lower) : joint(hinge.end, right);
        if (upper == kNone || lower == kNone || end == kNone) return;
        const auto first = pose.direction(upper, lower);
        const auto second = pose.direction(lower, end);
        const auto axis = first && second ? unit(glm::cross(*first, *second)) : std::nullopt;
        if (!axis || 1.0 - glm::dot(*first, *second) <= most) return;
        most = 1.0 - glm::dot(*first, *second);
        // A mirror turns axes of rotation the other way.
        const glm::dvec3 stands = right ? -mirrored_way(hinge.stands) : hinge.stands;
        aims_[upper].side = {glm::conjugate(pose.turn(upper)) * *axis, stands};
        aims_[lower].side = {glm::conjugate(pose.turn(lower)) * *axis, stands};
    }

    // --- where bones point

    /// From the right joint of a pair to the left one.
    [[nodiscard]] std::optional<glm::dvec3> across(Bone left) const {
        return way(bones_[mirrored(left)], bones_[left]);
    }

    void aim_trunk() {
        const std::uint32_t hips = bones_[Bone::hips];
        const std::uint32_t head = bones_[Bone::head];
        const std::uint32_t neck = bones_.has(Bone::neck) ? bones_[Bone::neck] : head;
        std::vector<std::uint32_t> column = joints_between(scene_, hips, neck);
        if (!base_.is_below(neck, hips)) column = path_of(scene_, bones_[Bone::spine], neck);
        const auto of_hips = across(Bone::left_upper_leg);
        const auto of_arms = across(Bone::left_shoulder);
        const auto of_chest = of_arms ? of_arms : across(Bone::left_upper_arm);
        aim(hips, of_hips, kLeft);
        // The lowest bone may be short and slanted, but where the body does not stand the spine is bent above it.
        const std::uint32_t next = column.empty() ? neck : up_ ? column[column.size() / 2] : column.front();
        aim_side(hips, up_from_hips(next), kUp);
        for (std::size_t k = 0; k < column.size(); ++k) {
            const double share = static_cast<double>(k + 1) / static_cast<double>(column.size());
            aim(column[k], way(column[k], k + 1 < column.size() ? column[k + 1] : neck), kUp);
            if (of_hips && of_chest) aim_side(column[k], unit(glm::mix(*of_hips, *of_chest, share)), kLeft);
        }
        if (neck != head) aim(neck, way(neck, head), kNeckStands);
        const std::uint32_t crown = end_of(head, "head");
        const auto eyes = across(Bone::left_eye);
        aim(head, way(head, crown), kCrownStands);
        if (crown != kNone) aim_side(head, eyes, kLeft);
    }

    /// The way from between the hip joints: the joint of the hips may be anywhere in the pelvis.
    [[nodiscard]] std::optional<glm::dvec3> up_from_hips(std::uint32_t to) const {
        const std::uint32_t left = bones_[Bone::left_upper_leg], right = bones_[Bone::right_upper_leg];
        if (to == kNone) return std::nullopt;
        if (left == kNone || right == kNone) return way(bones_[Bone::hips], to);
        return unit(base_.position(to) - 0.5 * (base_.position(left) + base_.position(right)));
    }

    /// The end of a head or hand, by its name: hair and hats are longer, and thumbs point elsewhere.
    [[nodiscard]] std::uint32_t end_of(std::uint32_t joint, const char* part) const {
        for (std::uint32_t child = 0; joint != kNone && child < scene_.joints.size(); ++child) {
            const NameWords name(scene_.joints[child].name);
            if (scene_.joints[child].parent == joint && name.has(part) && name.is_helper()) return child;
        }
        return kNone;
    }

    void aim_leg(bool right) {
        aim_bone(Bone::left_upper_leg, Bone::left_lower_leg, -kUp, right);
        aim_bone(Bone::left_lower_leg, Bone::left_foot, -kUp, right);
        aim_bone(Bone::left_foot, Bone::left_toes, foot_stands(), right);
        aim_bone(Bone::left_toes, kTip, kFront, right);
    }

    /// As slanted as both feet are in a pose that stands on them.
    [[nodiscard]] glm::dvec3 foot_stands() const {
        const auto left = way(bones_[Bone::left_foot], bones_[Bone::left_toes]);
        const auto right = way(bones_[Bone::right_foot], bones_[Bone::right_toes]);
        constexpr double kAlike = 0.14;  // 8 degrees
        if (!up_ || !left || !right || std::abs(glm::dot(*left - *right, *up_)) > kAlike) return kFootStands;
        const double rise = 0.5 * glm::dot(*left + *right, *up_);
        return {0.0, rise, std::sqrt(std::max(0.0, 1.0 - rise * rise))};
    }

    void aim_arm(bool right) {
        aim_bone(Bone::left_shoulder, Bone::left_upper_arm, kLeft, right);
        aim_bone(Bone::left_upper_arm, Bone::left_lower_arm, kLeft, right);
        aim_bone(Bone::left_lower_arm, Bone::left_hand, kLeft, right);
        const Bone middle =
            bones_.has(Bone::left_middle_proximal) ? Bone::left_middle_proximal : Bone::left_index_proximal;
        if (joint(middle, right) != kNone) {
            aim_bone(Bone::left_hand, middle, kLeft, right);
        } else {
            const std::uint32_t hand = joint(Bone::left_hand, right);
            aim(hand, way(hand, end_of(hand, "hand")), right ? mirrored_way(kLeft) : kLeft);
        }
        aim_side(joint(Bone::left_hand, right),
                 way(joint(Bone::left_index_proximal, right), joint(Bone::left_little_proximal, right)), -kFront);
        for (auto bone = static_cast<unsigned>(Bone::left_index_proximal);
             bone <= static_cast<unsigned>(Bone::left_little_distal); ++bone) {
            const bool is_last = (bone - static_cast<unsigned>(Bone::left_index_proximal)) % 3 == 2;
            aim_bone(static_cast<Bone>(bone), is_last ? kTip : static_cast<Bone>(bone + 1), kLeft, right);
        }
    }

    /// \param next  where the bone ends; kTip: at the joint's farthest child
    void aim_bone(Bone bone, Bone next, const glm::dvec3& stands, bool right) {
        const std::uint32_t from = joint(bone, right);
        std::uint32_t to = next == kTip ? kNone : joint(next, right);
        if (to == kNone && bone != Bone::left_hand) to = tip_of(from);
        aim(from, way(from, to), right ? mirrored_way(stands) : stands);
    }

    // --- the pose

    [[nodiscard]] std::vector<Transform> turned() const {
        std::vector<Transform> locals = rest_of(scene_);
        std::vector<bool> is_body(locals.size());
        for (std::size_t bone = 1; bone < kHumanBones; ++bone) {
            const std::uint32_t joint = bones_[static_cast<Bone>(bone)];
            if (joint != kNone) is_body[joint] = true;
        }
        std::vector<Rotation> turns;  // in model space
        for (std::uint32_t joint = 0; joint < locals.size(); ++joint) {
            const std::uint32_t parent = scene_.joints[joint].parent;
            const Rotation above = parent == kNone ? kNoTurn : turns[parent];
            glm::vec4& q = locals[joint].rotation;
            if (is_body[joint] || aims_[joint].along.own) {
                const Rotation in_base = parent == kNone ? kNoTurn : base_.turn(parent);
                const Rotation own = glm::normalize(
                    glm::conjugate(above) * turn_of(joint, above * glm::conjugate(in_base) * base_.turn(joint)));
                q = {own.x, own.y, own.z, own.w};
            }
            turns.push_back(glm::normalize(above * to_rotation({q.x, q.y, q.z, q.w})));
        }
        return locals;
    }

    /// \param carried  how the joint would be turned by the bone above alone
    [[nodiscard]] Rotation turn_of(std::uint32_t joint, const Rotation& carried) const {
        const Aims& aims = aims_[joint];
        if (!aims.along.own) return carried;
        if (aims.side.own) {
            if (const auto turn = turn_between(aims)) return *turn;
        }
        return swing(carried * *aims.along.own, aims.along.stands) * carried;
    }

    const Scene& scene_;
    const Humanoid& bones_;
    RestFrames base_;
    std::optional<glm::dvec3> up_;
    std::vector<Aims> aims_;                              ///< by joint
    std::array<double, 2 * kHinges.size()> most_bent_{};  ///< by hinge and side
};

}  // namespace

std::vector<Transform> assume_stand(const Scene& scene, const Humanoid& bones, const std::vector<Transform>& base,
                                    const std::optional<glm::dvec3>& up) {
    return StandAssumer(scene, bones, base, up).assume();
}

}  // namespace bendy::converter
