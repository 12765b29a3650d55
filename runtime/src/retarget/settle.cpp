#include "settle.h"

#include "stand.h"

#include "ik/constrain_joint.h"
#include "ik/ik_quick.h"
#include "math/rigid_part.h"
#include "pose/pose_state.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace bendy {
namespace {

constexpr std::size_t kLegs = 2;  // the first limbs

/// A limb in one frame, model space.
struct LimbFrame {
    glm::dvec3 middle{0.0};
    double extended = 0.0;                ///< metres from its start to its end, as in the source
    glm::dvec3 wanted{0.0};               ///< of its end
    glm::dvec3 bend{0.0};                 ///< unit: where knee or elbow point
    glm::dquat turn{1.0, 0.0, 0.0, 0.0};  ///< of its end
    double planted = 0.0;                 ///< how far `wanted` is decided by the ground: 0 to 1
};

class Settling {
public:
    Settling(const RetargetPlan& plan, Pose& source, Pose& pose)
        : plan_(plan), source_(PoseState::of(source)), pose_(pose), to_(PoseState::of(pose)) {}

    Retargeted run(RetargetState& state, const std::optional<ContactWeights>& contacts) {
        for (std::size_t k = 0; k < limbs_.size(); ++k) {
            if (plan_.limbs[k].can_reach) read_limb(plan_.limbs[k], limbs_[k]);
        }
        for (std::size_t k = 0; k < kLegs && plan_.options.plants_feet; ++k) plant(k, state, contacts);
        if (plan_.options.obey_constraints) constrain_all();
        lower_hips();
        for (std::size_t k = 0; k < limbs_.size(); ++k) {
            if (plan_.limbs[k].can_reach) finish(plan_.limbs[k], limbs_[k]);
        }
        return result_;
    }

private:
    [[nodiscard]] glm::dvec3 place(std::uint32_t joint) const { return {to_.fresh_matrix(joint)[3]}; }

    void read_limb(const LimbPlan& plan, LimbFrame& limb) const {
        const glm::dmat4 upper = to_.fresh_matrix(plan.upper);
        const glm::dmat4 end = to_.fresh_matrix(plan.end);
        limb.middle = place(plan.lower);
        limb.wanted = glm::dvec3(end[3]);
        limb.extended = glm::length(limb.wanted - glm::dvec3(upper[3]));
        limb.bend = glm::dmat3(upper) * plan.bend;
        limb.turn = rigid_rotation(end);
    }

    void plant(std::size_t leg, RetargetState& state, const std::optional<ContactWeights>& contacts) {
        const LimbPlan& plan = plan_.limbs[leg];
        const FootPlan& foot = plan_.feet[leg];
        if (!plan.can_reach) return;
        RetargetState::Stand& heel = state.stands[2 * leg];
        RetargetState::Stand& toes = state.stands[2 * leg + 1];
        FootContact contact;
        if (contacts) {
            contact = {fraction((*contacts)[2 * leg]), fraction((*contacts)[2 * leg + 1])};
        } else {
            contact = find_contact(plan_, foot, source_, toes.weight);
        }
        result_.contacts[2 * leg] = contact.heel;
        result_.contacts[2 * leg + 1] = contact.toes;
        const Foot now{limbs_[leg].wanted, glm::dmat3(to_.fresh_matrix(plan.end)) * foot.toes_at};
        const Standing standing = stand(plan_, foot, source_, now, contact, heel, toes);
        limbs_[leg].wanted = standing.ankle;
        limbs_[leg].planted = standing.weight;
    }

    /// NaN counts as 0.
    static float fraction(float weight) { return weight > 0.0f ? std::min(weight, 1.0f) : 0.0f; }

    void constrain_all() {
        for (const Constraint& constraint : plan_.target.constraints()) {
            if (plan_.target.constraint(constraint.joint) == &constraint) constrain(constraint);
        }
    }

    void constrain(const Constraint& constraint) {
        const auto angle = static_cast<float>(constrain_joint(pose_, constraint));
        if (angle <= result_.turned) return;
        result_.turned = angle;
        result_.turned_joint = constraint.joint;
    }

    /// Lowers the hips until the feet that stand on the ground are within reach.
    void lower_hips() {
        double lowered = 0.0;
        for (std::size_t k = 0; k < kLegs; ++k) {
            if (limbs_[k].planted > 0.0) lowered = std::max(lowered, lowering_for(plan_.limbs[k], limbs_[k]));
        }
        if (!(lowered > 0.0) || plan_.hips.joint == kNone) return;
        const std::uint32_t parent = plan_.target.parents()[plan_.hips.joint];
        const glm::dmat3 space(to_.fresh_matrix(parent));
        if (!(std::abs(glm::determinant(space)) > 1e-30)) return;
        const glm::dvec3 shift = -lowered * plan_.up;
        JointTransform local = to_.local_of(plan_.hips.joint);
        local.translation += glm::vec3(glm::inverse(space) * shift);
        to_.set_local(plan_.hips.joint, local);
        for (LimbFrame& limb : limbs_) {
            limb.wanted += (1.0 - limb.planted) * shift;
            limb.middle += shift;
        }
        result_.lowered = static_cast<float>(lowered);
    }

    [[nodiscard]] double lowering_for(const LimbPlan& plan, const LimbFrame& limb) const {
        constexpr double kNearlyStraight = 0.995;  // of the length
        constexpr double kMost = 0.1;              // of the length
        const double reach = std::clamp(limb.extended, kNearlyStraight * plan.length, plan.length);
        const glm::dvec3 way = place(plan.upper) - limb.wanted;
        const double height = glm::dot(way, plan_.up);
        const double across = glm::dot(way, way) - height * height;
        if (across + height * height <= reach * reach) return 0.0;
        const double left = reach * reach - across;
        const double lowered = left > 0.0 ? height - std::sqrt(left) : kMost * plan.length;
        return limb.planted * std::clamp(lowered, 0.0, kMost * plan.length);
    }

    void finish(const LimbPlan& plan, const LimbFrame& limb) {
        constexpr double kThere = 1e-5;  // of the length
        double missed = glm::length(place(plan.end) - limb.wanted);
        if (missed > kThere * plan.length) {
            reach_for(plan, limb);
            missed = glm::length(place(plan.end) - limb.wanted);
        }
        if (missed <= double{result_.missed}) return;
        result_.missed = static_cast<float>(missed);
        result_.missed_joint = plan.end;
    }

    void reach_for(const LimbPlan& plan, const LimbFrame& limb) {
        const Chain& chain = plan.chain != nullptr ? *plan.chain : plan.own;
        ReachOptions options;
        options.solver = Solver::two_bone;
        options.obey_constraints = plan_.options.obey_constraints;
        // The knee stays where it was; a straight leg bends to the side that it bends to at rest.
        constexpr double kAside = 0.05;
        options.pole = glm::vec3(limb.middle + kAside * plan.length * limb.bend);
        const ReachTarget target{glm::vec3(limb.wanted)};
        if (!reach_quickly(chain, target, pose_, options)) (void)reach_at_length(chain, target, pose_, options);
        const glm::dquat space = rigid_rotation(to_.fresh_matrix(plan_.target.parents()[plan.end]));
        to_.set_rotation(plan.end, glm::quat(glm::normalize(glm::conjugate(space) * limb.turn)));
        if (!plan_.options.obey_constraints) return;
        for (const std::uint32_t joint : {plan.upper, plan.lower, plan.end}) {
            if (const Constraint* constraint = plan_.target.constraint(joint)) constrain(*constraint);
        }
    }

    const RetargetPlan& plan_;
    PoseState& source_;
    Pose& pose_;
    PoseState& to_;
    std::array<LimbFrame, 4> limbs_{};
    Retargeted result_;
};

}  // namespace

Retargeted settle(const RetargetPlan& plan, Pose& source, Pose& pose, RetargetState& state,
                  const std::optional<ContactWeights>& contacts) {
    return Settling(plan, source, pose).run(state, contacts);
}

}  // namespace bendy
