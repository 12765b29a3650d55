#include "settle.h"

#include "limits_pass.h"
#include "plant_contacts.h"
#include "reach_contacts.h"
#include "settled_frame.h"
#include "touch.h"

#include "math/rigid_part.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <cmath>
#include <cstddef>

namespace bendy {
namespace {

void read_limb(SettledFrame& frame, const LimbPlan& plan, LimbFrame& limb) {
    const glm::dmat4 upper = frame.to.fresh_matrix(plan.upper);
    const glm::dmat4 end = frame.to.fresh_matrix(plan.end);
    limb.wanted = glm::dvec3(end[3]);
    limb.below = frame.place(plan.foot) - limb.wanted;
    limb.extended = glm::length(limb.wanted - glm::dvec3(upper[3]));
    limb.bend = glm::dmat3(upper) * plan.bend;
    limb.turn = rigid_rotation(end);
}

}  // namespace

void place_detached(const RetargetPlan& plan, PoseState& target) {
    for (const DetachedJoint& detached : plan.detached) {
        const glm::dvec4 place = target.fresh_matrix(detached.carrier) * glm::dvec4(detached.place, 1.0);
        const glm::dmat4 space = target.fresh_matrix(plan.target.parents()[detached.joint]);
        if (!(std::abs(glm::determinant(space)) > 1e-30)) continue;
        JointTransform local = target.local_of(detached.joint);
        local.translation = glm::vec3(glm::inverse(space) * place);
        target.set_local(detached.joint, local);
    }
}

Retargeted settle(RetargetPlan& plan, Pose& source, Pose& pose, RetargetState& state,
                  const std::optional<ContactWeights>& contacts) {
    SettledFrame frame(plan, source, pose);
    if (plan.options.plants_feet) lay_body(frame, contacts);
    for (std::size_t k = 0; k < plan.limbs.size(); ++k) {
        if (plan.limbs[k].can_reach) read_limb(frame, plan.limbs[k], frame.limbs.at(k));
    }
    if (plan.options.plants_feet) plant_limbs(frame, state, contacts);
    if (plan.options.limits != Limits::off) {
        constrain_all(frame);
        lay_again(frame);
    }
    lower_hips(frame);
    if (plan.options.plants_feet && plan.is_human) {
        touch_body(frame, contacts);
        join_hands(frame, contacts);
    }
    reach_contacts(frame);
    return frame.result;
}

}  // namespace bendy
