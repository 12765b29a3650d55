#pragma once

#include "surface.h"

#include "model/standing_rotations.h"

#include <bendy/runtime/model.h>
#include <bendy/runtime/retarget.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace bendy {

inline constexpr glm::dquat kNoTurn{1.0, 0.0, 0.0, 0.0};

/// A joint of the source whose orientation is computed in each frame.
struct SourceJoint {
    std::uint32_t joint = 0;
    std::uint32_t above = kNone;  ///< among the source joints
    bool mirrors = false;
    glm::dquat flip{1, 0, 0, 0};  ///< if it mirrors: see Body::flip
};

/// A turn between those of two source joints, for columns of different numbers of joints.
struct MixedTurn {
    std::uint32_t a = 0, b = 0;                         ///< among the source joints
    glm::dquat rest_a{1, 0, 0, 0}, rest_b{1, 0, 0, 0};  ///< inverse orientations at rest
    double share = 0.0;                                 ///< of b
};

/// A joint of the target that the source moves: its rotation is before * conj(turn above) * turn * after. Turns are
/// orientations of source joints, then the mixed ones.
struct MovedJoint {
    std::uint32_t joint = 0;
    std::uint32_t source = kNone;  ///< the source's joint; the nearer one of a mixed turn
    std::uint32_t turn = 0;
    std::uint32_t above = kNone;    ///< the turn of the nearest moved joint above; kNone: none
    std::uint32_t carrier = kNone;  ///< that joint, among the moved ones
    glm::dquat before{1, 0, 0, 0}, after{1, 0, 0, 0};
    bool is_copy = false;                    ///< all of the source joint's numbers
    const Constraint* constraint = nullptr;  ///< of the target's joint, in poses
    std::uint32_t limb = kNone;              ///< whose upper joint it is
    bool is_prop = false;                    ///< translations and scales come along
    glm::dmat3 travel{1.0};                  ///< of a prop: from the source's translation since rest to the target's
};

/// What the hips' position follows.
struct HipsPlan {
    std::uint32_t joint = kNone;            ///< of the target; kNone: copied
    std::array<std::uint32_t, 2> source{};  ///< joints whose middle travels: the hip joints
    glm::dvec3 middle{0.0};                 ///< of the target's, in the space of its hips at rest
    std::vector<std::uint32_t> above;       ///< joints above the hips, from the root
};

/// A joint of the target that the body holds, but not the skeleton: a foot beside its leg, a leg beside the hips.
struct DetachedJoint {
    std::uint32_t joint = 0, carrier = 0;
    glm::dvec3 place{0.0};  ///< at rest, in the carrier's space
};

/// From positions in the source's model space to the target's.
struct SpaceMap {
    glm::dquat turn{1, 0, 0, 0};
    double scale = 1.0;
    glm::dvec3 from{0.0}, to{0.0};  ///< corresponding points

    [[nodiscard]] glm::dvec3 operator()(const glm::dvec3& place) const { return to + turn * (scale * (place - from)); }
};

/// A point of the foot that may touch the ground.
struct ContactPlan {
    std::uint32_t source = kNone;  ///< joint; kNone: the foot has no such point
    double rest_height = 0.0;      ///< of the source's, along its up, above the space map's point
    double lift = 0.0;             ///< metres to add to a mapped position, so that it rests at the target's height
};

/// An arm or a leg of the target; one that either body has only in part cannot reach.
struct LimbPlan {
    std::uint32_t upper = kNone, lower = kNone, end = kNone;
    std::uint32_t foot = kNone;    ///< or hand; of an animal it may be below the end: `end` is the hock then
    const Chain* chain = nullptr;  ///< of the target; null: `own`
    Chain own;
    bool can_reach = false;
    bool is_arm = false;
    double length = 0.0;
    glm::dvec3 bend{0.0};  ///< unit: where knee or elbow point at rest, in the space of the upper joint
    /// Units: the upper bone and, across it, the side to which limits of knee or elbow let the lower bone bend, in the
    /// space of the upper joint; and the lower bone in its own. The side is zero if there is none.
    glm::dvec3 upper_bone{0.0}, lower_side{0.0}, lower_bone{0.0};
};

/// A leg: where its foot stands. Or an arm: a hand is a heel whose heights follow from the skin, frame by frame.
struct FootPlan {
    ContactPlan heel, toes;
    std::uint32_t turn = 0;       ///< of the source's foot
    glm::dquat rest{1, 0, 0, 0};  ///< its inverse orientation at rest
    std::uint32_t toes_carrier = 0;
    glm::dvec3 toes_at{0.0};  ///< the target's toes in the space of their carrier, at rest
};

struct RetargetPlan {
    RetargetPlan(Model from, Model to) : source(std::move(from)), target(std::move(to)) {}
    static RetargetPlan& of(Retarget& retarget) { return *retarget.plan_; }
    static Result<Retarget, RetargetError> make(const Model& source, const Model& target,
                                                const RetargetOptions& options);

    Model source, target;
    RetargetOptions options;
    std::vector<std::uint32_t> joints;         ///< see Retarget::joints
    std::vector<std::uint32_t> morph_targets;  ///< see Retarget::morph_targets
    std::vector<SourceJoint> source_joints;
    std::vector<MixedTurn> mixed_turns;
    std::vector<MovedJoint> moved;
    std::vector<StandingJoint> standing;               ///< joints of the target that the source does not move
    std::vector<const Constraint*> other_constraints;  ///< of joints that are not moved
    std::vector<DetachedJoint> detached;               ///< from the trunk outwards
    HipsPlan hips;
    SpaceMap map;
    glm::dvec3 source_up{0, 1, 0}, up{0, 1, 0};
    double source_leg = 1.0, leg = 1.0;  ///< metres: see Retarget::leg
    double source_arm = 1.0;             ///< metres: from shoulder to hand
    bool is_human = true;
    std::vector<LimbPlan> limbs;      ///< see Body::limbs
    std::vector<FootPlan> feet;       ///< of the first limbs
    std::array<FootPlan, 2> hands;    ///< of the limbs behind those, of a human
    Surface source_surface, surface;  ///< empty if only feet touch the ground

    std::vector<glm::dquat> held;   ///< work memory: of each moved joint, by what limits above it have turned it
    std::vector<glm::dquat> turns;  ///< work memory: of the source joints, then the mixed ones
};

}  // namespace bendy
