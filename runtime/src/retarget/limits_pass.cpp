#include "limits_pass.h"

#include "settle.h"

#include "ik/constrain_joint.h"
#include "math/rotation.h"
#include "math/smooth.h"

#include <bendy/format/trig.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace bendy {
namespace {

constexpr double kFullTurn = 6.283185307179586;
// When an upper bone turns about itself for the lower one: sines of the angle between them; radians from the side to
// which that bends; and radians by which it is off, where half of the turn is made.
constexpr double kElbowBent[] = {0.1, 0.3}, kElbowBehind[] = {1.9, 2.9}, kSlack = 0.035;
constexpr double kFarBeyond = 0.79, kMostBeyond = 1.57;  // radians: 45 and 90 degrees

/// A forearm or a shin that is to turn about its own axis far beyond the limits of the elbow or knee would jump
/// from one end to the other, where both are equally near. So the farther beyond, the nearer to rest is its turn.
void relax(SettledFrame& frame, const Constraint& constraint, const glm::dquat& wanted) {
    const auto limb = std::find_if(frame.plan.limbs.begin(), frame.plan.limbs.end(),
                                   [&](const LimbPlan& one) { return one.lower == constraint.joint; });
    if (limb == frame.plan.limbs.end() || frame.plan.target.parents()[limb->end] != limb->lower) return;
    const glm::dvec3 bone(frame.to.local_of(limb->end).translation);
    if (!(glm::dot(bone, bone) > 0.0)) return;
    const glm::dvec3 axis = glm::normalize(bone);
    const glm::dquat back = glm::conjugate(glm::dquat(frame.plan.target.joints()[constraint.joint].rest.rotation));
    const auto turn_of = [&](const glm::dquat& rotation) {
        const glm::dquat turn = back * rotation;
        return 2.0 * trig::atan2(glm::dot(glm::dvec3(turn.x, turn.y, turn.z), axis), turn.w);
    };
    const glm::dquat now(frame.to.local_of(constraint.joint).rotation);
    const double turn = std::remainder(turn_of(now), kFullTurn);
    const double beyond = std::abs(std::remainder(turn_of(wanted) - turn, kFullTurn));
    if (beyond <= kFarBeyond) return;
    const double share = std::min(1.0, (beyond - kFarBeyond) / (kMostBeyond - kFarBeyond));
    frame.to.set_rotation(constraint.joint, glm::quat(glm::normalize(now * from_vector(-share * turn * axis))));
    (void)constrain(frame, constraint);
}

/// Returns the angle by which the joint was turned back, radians.
double constrain_far(SettledFrame& frame, const MovedJoint& moved) {
    const glm::dquat before(frame.to.local_of(moved.joint).rotation);
    const double outside = constrain(frame, *moved.constraint);
    if (outside > kFarBeyond) relax(frame, *moved.constraint, before);
    return outside;
}

/// Returns by what the upper bone is to turn about itself, so that the lower one can point to where the source's
/// does: an elbow bends to one side only. 0 if it can point there, or is nearly straight.
double twist_for_lower(SettledFrame& frame, const LimbPlan& limb) {
    if (limb.lower_side == glm::dvec3(0.0)) return 0.0;
    const JointTransform before = frame.to.local_of(limb.lower);
    const glm::dvec3 wanted = glm::dquat(before.rotation) * limb.lower_bone;
    const glm::dvec3 across = wanted - limb.upper_bone * glm::dot(wanted, limb.upper_bone);
    const double bent = glm::length(across);
    if (!(bent > kElbowBent[0])) return 0.0;
    (void)constrain_joint(frame.pose, *frame.plan.target.constraint(limb.lower), Legal::quick);
    const glm::dvec3 legal = glm::dquat(frame.to.local_of(limb.lower).rotation) * limb.lower_bone;
    frame.to.set_local(limb.lower, before);
    const double off = glm::length(legal - wanted);
    const double angle =
        trig::atan2(glm::dot(limb.upper_bone, glm::cross(limb.lower_side, across)), glm::dot(limb.lower_side, across));
    const double share =
        smooth(bent, kElbowBent[0], kElbowBent[1]) * (1.0 - smooth(std::abs(angle), kElbowBehind[0], kElbowBehind[1]));
    return angle * share * off * off / (off * off + kSlack * kSlack);
}

void constrain_moved(SettledFrame& frame, std::size_t number) {
    const MovedJoint& moved = frame.plan.moved[number];
    const bool is_held = moved.carrier != kNone && frame.plan.held[moved.carrier] != kNoTurn;
    glm::dquat& held = frame.plan.held[number];
    held = kNoTurn;
    const double twist = moved.limb == kNone ? 0.0 : twist_for_lower(frame, frame.plan.limbs[moved.limb]);
    if (!is_held && moved.constraint == nullptr && twist == 0.0) return;
    const glm::dquat wanted = frame.plan.turns[moved.turn] * moved.after;
    const glm::dquat space = moved.above == kNone ? glm::conjugate(moved.before)
                                                  : frame.plan.turns[moved.above] * glm::conjugate(moved.before);
    const glm::dquat actual_space = is_held ? frame.plan.held[moved.carrier] * space : space;
    if (is_held) frame.to.set_rotation(moved.joint, glm::quat(glm::normalize(glm::conjugate(actual_space) * wanted)));
    if (twist != 0.0) {
        const glm::dquat turned = glm::dquat(frame.to.local_of(moved.joint).rotation) *
                                  from_vector(twist * frame.plan.limbs[moved.limb].upper_bone);
        frame.to.set_rotation(moved.joint, glm::quat(glm::normalize(turned)));
    }
    const double outside = moved.constraint == nullptr ? 0.0 : constrain_far(frame, moved);
    if (outside == 0.0 && twist == 0.0) return;
    held = glm::normalize(actual_space * glm::dquat(frame.to.local_of(moved.joint).rotation) * glm::conjugate(wanted));
}

}  // namespace

bool is_soft(const SettledFrame& frame, const Constraint& constraint) {
    return frame.plan.options.limits == Limits::soft && (constraint.record.flags & kProposed) != 0;
}

bool obeys_limits(const SettledFrame& frame, const LimbPlan& plan) {
    if (frame.plan.options.limits != Limits::soft) return frame.plan.options.limits == Limits::hard;
    const std::array joints{plan.upper, plan.lower, plan.end};
    return std::any_of(joints.begin(), joints.end(), [&](std::uint32_t joint) {
        const std::uint32_t number = frame.to.data->ik_constraint(joint);
        return number != kNone && !is_soft(frame, frame.to.data->constraints[number]);
    });
}

double constrain(SettledFrame& frame, const Constraint& constraint) {
    const glm::dquat before(frame.to.local_of(constraint.joint).rotation);
    double outside = constrain_joint(frame.pose, constraint, Legal::quick);
    if (outside > 0.0 && is_soft(frame, constraint)) {
        const double kept = 1.0 / (1.0 + outside / kSoftLimit);  // of the angle
        const glm::dquat legal(frame.to.local_of(constraint.joint).rotation);
        frame.to.set_rotation(constraint.joint, glm::quat(between(legal, glm::normalize(before), kept)));
        outside *= 1.0 - kept;
    }
    const auto angle = static_cast<float>(outside);
    if (angle > frame.result.turned) {
        frame.result.turned = angle;
        frame.result.turned_joint = constraint.joint;
    }
    return angle;
}

void constrain_all(SettledFrame& frame) {
    for (std::size_t k = 0; k < frame.plan.moved.size(); ++k) constrain_moved(frame, k);
    for (const Constraint* constraint : frame.plan.other_constraints) (void)constrain(frame, *constraint);
    place_detached(frame.plan, frame.to);
}

}  // namespace bendy
