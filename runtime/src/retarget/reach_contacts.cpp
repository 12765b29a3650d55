#include "reach_contacts.h"

#include "limits_pass.h"
#include "settle.h"

#include "ik/ik_quick.h"
#include "math/rigid_part.h"
#include "math/rotation.h"
#include "math/smooth.h"

#include <bendy/runtime/turn.h>

#include <glm/geometric.hpp>

#include <array>
#include <cstddef>

namespace bendy {
namespace {

// If limits stop a hand on its way, the arm gives up part of the reach: none up to the first share of the distance
// left, all of it from the second on.
constexpr double kWorth[] = {0.3, 0.9};

/// Returns true if a constraint limits knee or elbow while a solver works.
bool has_limits(SettledFrame& frame, const LimbPlan& plan) {
    return obeys_limits(frame, plan) && frame.to.data->ik_constraint(plan.lower) != kNone;
}

/// Returns true if an animal's leg is bent to the wrong side, which wide limits allow.
bool is_turned_over(SettledFrame& frame, const LimbPlan& plan) {
    if (frame.plan.is_human || !has_limits(frame, plan)) return false;
    constexpr double kClearly = 0.03;  // of the length
    const glm::dvec3 start = frame.place(plan.upper), way = frame.place(plan.end) - start,
                     middle = frame.place(plan.lower) - start;
    const glm::dvec3 bend = glm::dmat3(frame.to.fresh_matrix(plan.upper)) * plan.bend;
    const double length = glm::dot(way, way);
    if (!(length > 0.0)) return false;
    return glm::dot(middle - way * (glm::dot(middle, way) / length), glm::normalize(bend)) < -kClearly * plan.length;
}

/// Turns a joint with all below it in model space.
void turn_joint(SettledFrame& frame, std::uint32_t joint, const glm::dquat& turn) {
    const glm::dquat space = rigid_rotation(frame.to.fresh_matrix(frame.plan.target.parents()[joint]));
    const glm::dquat local = glm::conjugate(space) * turn * space * glm::dquat(frame.to.local_of(joint).rotation);
    frame.to.set_rotation(joint, glm::quat(glm::normalize(local)));
}

/// Bends a limb that is straight, or a leg that is bent to the wrong side, a little to the side that it bends to,
/// so that a solver continues from there. Turns neither of its bones about its axis.
void bend_a_little(SettledFrame& frame, const LimbPlan& plan, const LimbFrame& limb) {
    constexpr double kLeast = 0.03;  // of the length
    const glm::dvec3 start = frame.place(plan.upper), middle = frame.place(plan.lower), end = frame.place(plan.end);
    const glm::dvec3 way = end - start;
    const double length = glm::dot(way, way);
    if (!(length > 0.0)) return;
    const auto across = [&](const glm::dvec3& v) { return v - way * (glm::dot(v, way) / length); };
    const glm::dvec3 side = across(limb.bend);
    if (!(glm::length(side) > 0.1)) return;
    if (plan.is_arm && glm::length(across(middle - start)) > kLeast * plan.length) return;
    const double bent = glm::dot(middle - start, glm::normalize(side));
    if (bent > kLeast * plan.length) return;
    const glm::dvec3 moved = middle + (kLeast * plan.length - bent) * glm::normalize(side);
    const glm::dquat upper = between(middle - start, moved - start);
    turn_joint(frame, plan.upper, upper);
    turn_joint(frame, plan.lower, between(upper * (end - middle), end - moved));
}

void reach_for(SettledFrame& frame, const LimbPlan& plan, const LimbFrame& limb, Solver solver) {
    const Chain& chain = plan.chain != nullptr ? *plan.chain : plan.own;
    ReachOptions options;
    options.solver = solver;
    // An arm reaches freely and is then moved inside its limits, so that it does not jump where they stop it.
    options.obey_constraints = obeys_limits(frame, plan) && !plan.is_arm;
    // Without a pole the solver keeps the plane in which a limb is bent.
    options.softness = 0.0f;
    options.restarts = 0;
    // A knee with limits knows where it bends to.
    if (!has_limits(frame, plan)) bend_a_little(frame, plan, limb);
    const ReachTarget target{glm::vec3(limb.wanted)};
    const bool is_reached = solver == Solver::two_bone && reach_quickly(chain, target, frame.pose, options);
    if (!is_reached) (void)reach_at_length(chain, target, frame.pose, options);
    place_detached(frame.plan, frame.to);
    const glm::dquat space = rigid_rotation(frame.to.fresh_matrix(frame.plan.target.parents()[plan.end]));
    frame.to.set_rotation(plan.end, glm::quat(glm::normalize(glm::conjugate(space) * limb.turn)));
    if (frame.plan.options.limits == Limits::off) return;
    for (const std::uint32_t joint : {plan.upper, plan.lower, plan.end}) {
        const Constraint* constraint = frame.plan.target.constraint(joint);
        // Soft limits have acted on the arm already; a short reach does not call for them again.
        if (constraint != nullptr && !(plan.is_arm && is_soft(frame, *constraint))) (void)constrain(frame, *constraint);
    }
}

/// Undoes part of a joint's turn. \param share  of the turn that is kept, 0 to 1
void go_back(SettledFrame& frame, std::uint32_t joint, const JointTransform& before, double share) {
    const Constraint* const limit =
        frame.plan.options.limits == Limits::off ? nullptr : frame.plan.target.constraint(joint);
    const glm::quat& rest = frame.plan.target.joints()[joint].rest.rotation;
    frame.to.set_rotation(joint, turn_part_way(limit, rest, before.rotation, frame.to.local_of(joint).rotation, share));
}

double distance_left(SettledFrame& frame, const LimbPlan& plan, const LimbFrame& limb) {
    return glm::length(frame.place(plan.foot) - (limb.wanted + limb.below));
}

/// Leaves a leg as it is if it cannot come nearer within the limits, or only turned over; an arm goes back as far
/// as it cannot. Returns the distance that is left.
double try_to_reach(SettledFrame& frame, const LimbPlan& plan, const LimbFrame& limb, double distance) {
    const std::array joints{plan.upper, plan.lower, plan.end};
    std::array<JointTransform, joints.size()> before;
    for (std::size_t k = 0; k < joints.size(); ++k) before[k] = frame.to.local_of(joints[k]);
    if (plan.is_arm) {
        reach_for(frame, plan, limb, Solver::two_bone);
        const double share = 1.0 - smooth(distance_left(frame, plan, limb) / distance, kWorth[0], kWorth[1]);
        for (std::size_t k = 0; k < joints.size() && share < 1.0; ++k) go_back(frame, joints[k], before[k], share);
        return distance_left(frame, plan, limb);
    }
    // Where limits stop the two-bone solver, it turns a leg over; least squares go on from its pose.
    for (const Solver solver : {Solver::two_bone, Solver::least_squares}) {
        reach_for(frame, plan, limb, solver);
        const double left = distance_left(frame, plan, limb);
        const bool is_over = is_turned_over(frame, plan);
        if (left <= distance && !is_over) return left;
        for (std::size_t k = 0; k < joints.size(); ++k) frame.to.set_local(joints[k], before[k]);
        if (!is_over) break;
    }
    return distance;
}

/// Only feet that stand reach: everything else keeps its direction as far as limits allow.
void finish(SettledFrame& frame, const LimbPlan& plan, const LimbFrame& limb) {
    constexpr double kThere = 1e-5;  // of the length
    double missed = distance_left(frame, plan, limb);
    if ((limb.planted > 0.0 || limb.joined > 0.0) && missed > kThere * plan.length)
        missed = try_to_reach(frame, plan, limb, missed);
    if (missed <= double{frame.result.missed}) return;
    frame.result.missed = static_cast<float>(missed);
    frame.result.missed_joint = plan.foot;
}

}  // namespace

void reach_contacts(SettledFrame& frame) {
    for (std::size_t k = 0; k < frame.plan.limbs.size(); ++k) {
        if (frame.plan.limbs[k].can_reach) finish(frame, frame.plan.limbs[k], frame.limbs.at(k));
    }
}

}  // namespace bendy
