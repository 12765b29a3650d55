#include "settle.h"

#include "stand.h"

#include "ik/constrain_joint.h"
#include "ik/ik_quick.h"
#include "math/rigid_part.h"
#include "math/rotation.h"
#include "pose/pose_state.h"

#include <bendy/format/trig.h>
#include <bendy/runtime/turn.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace bendy {
namespace {

constexpr std::size_t kMostLimbs = 4;
constexpr float kContactRounding = 0.005f;  // of contacts that are given: curves leave out keys
constexpr double kFullTurn = 6.283185307179586;
// When an upper bone turns about itself for the lower one: sines of the angle between them; radians from the side to
// which that bends; and radians by which it is off, where half of the turn is made.
constexpr double kBent[] = {0.1, 0.3}, kBehind[] = {1.9, 2.9}, kSlack = 0.035;
// If limits stop a hand on its way, the arm gives up part of the reach: none up to the first share of the distance
// left, all of it from the second on.
constexpr double kWorth[] = {0.3, 0.9};
constexpr double kFarBeyond = 0.79, kMostBeyond = 1.57;  // radians: 45 and 90 degrees

/// A limb in one frame, model space.
struct LimbFrame {
    double extended = 0.0;                ///< metres from its start to its end, as in the source
    glm::dvec3 wanted{0.0};               ///< of its end
    glm::dvec3 below{0.0};                ///< from its end to its foot or hand
    glm::dvec3 bend{0.0};                 ///< unit: where knee or elbow point
    glm::dquat turn{1.0, 0.0, 0.0, 0.0};  ///< of its end
    double joined = 0.0;                  ///< how far `wanted` is decided by the other hand: 0 to 1
    double planted = 0.0;                 ///< how far `wanted` is decided by the ground: 0 to 1
};

/// From 0 to 1 between two numbers.
double smooth(double number, double from, double to) {
    const double share = std::clamp((number - from) / (to - from), 0.0, 1.0);
    return share * share * (3.0 - 2.0 * share);
}

class Settling {
public:
    Settling(RetargetPlan& plan, Pose& source, Pose& pose)
        : plan_(plan), source_(PoseState::of(source)), pose_(pose), to_(PoseState::of(pose)) {}

    Retargeted run(RetargetState& state, const std::optional<ContactWeights>& contacts) {
        if (plan_.options.plants_feet) lay_body(contacts);
        for (std::size_t k = 0; k < plan_.limbs.size(); ++k) {
            if (plan_.limbs[k].can_reach) read_limb(plan_.limbs[k], limbs_[k]);
        }
        if (plan_.options.plants_feet) plant_all(state, contacts);
        if (plan_.options.limits != Limits::off) {
            constrain_all();
            lay_again();
        }
        lower_hips();
        if (plan_.options.plants_feet && plan_.is_human) join_hands(contacts);
        for (std::size_t k = 0; k < plan_.limbs.size(); ++k) {
            if (plan_.limbs[k].can_reach) finish(plan_.limbs[k], limbs_[k]);
        }
        return result_;
    }

private:
    [[nodiscard]] glm::dvec3 place(std::uint32_t joint) const { return {to_.fresh_matrix(joint)[3]}; }

    void read_limb(const LimbPlan& plan, LimbFrame& limb) const {
        const glm::dmat4 upper = to_.fresh_matrix(plan.upper);
        const glm::dmat4 end = to_.fresh_matrix(plan.end);
        limb.wanted = glm::dvec3(end[3]);
        limb.below = place(plan.foot) - limb.wanted;
        limb.extended = glm::length(limb.wanted - glm::dvec3(upper[3]));
        limb.bend = glm::dmat3(upper) * plan.bend;
        limb.turn = rigid_rotation(end);
    }

    /// Brings the body of who sits, lies or kneels to the height above the ground that the source's has, although it
    /// may be thicker; but not below the ground, where many a source is.
    void lay_body(const std::optional<ContactWeights>& contacts) {
        Surface &from = plan_.source_surface, &to = plan_.surface;
        if (from.body.shares.empty() || to.body.shares.empty() || plan_.hips.joint == kNone) return;
        const double height = source_height(from.body) / plan_.source_leg;
        double above_feet = height;
        for (std::size_t k = 0; k < plan_.feet.size(); ++k)
            above_feet = std::max(above_feet, height - source_height(from.ends.at(k)) / plan_.source_leg);
        lying_ = weight_of(Contact::body, contacts, body_contact(height, above_feet));
        body_height_ = height * plan_.leg;
        (void)shift_body();
    }

    /// Returns the shift.
    glm::dvec3 shift_body() {
        const double now = height_of(plan_.surface.body);
        const double laid = std::max(std::max(body_height_, 0.0) - now, -height_of(plan_.surface.arms));
        const double sunk = std::min(body_height_, 0.0) - now;  // who crouches does not sink, either
        const double shift = std::max(lying_ * laid, sunk);
        if (!(lying_ > 0.0) && !(shift > 0.0)) return glm::dvec3(0.0);
        move_hips(shift * plan_.up);
        return shift * plan_.up;
    }

    /// Limits turn head and trunk.
    void lay_again() {
        if (!std::isfinite(body_height_)) return;
        const glm::dvec3 shift = shift_body();
        for (LimbFrame& limb : limbs_) limb.wanted += (1.0 - limb.planted) * shift;
    }

    /// Returns the height above the ground of the source's or the target's lowest point, metres.
    double source_height(SurfacePart& part) {
        return part.lowest(source_, plan_.source_up) - plan_.source_surface.floor;
    }
    double height_of(SurfacePart& part) { return part.lowest(to_, plan_.up) - plan_.surface.floor; }

    /// Moves the hips with all below them, in model space.
    void move_hips(const glm::dvec3& shift) {
        const std::uint32_t parent = plan_.target.parents()[plan_.hips.joint];
        const glm::dmat3 space(to_.fresh_matrix(parent));
        if (!(std::abs(glm::determinant(space)) > 1e-30)) return;
        JointTransform local = to_.local_of(plan_.hips.joint);
        local.translation += glm::vec3(glm::inverse(space) * shift);
        to_.set_local(plan_.hips.joint, local);
        place_detached(plan_, to_);
    }

    void plant_all(RetargetState& state, const std::optional<ContactWeights>& contacts) {
        for (std::size_t k = 0; k < plan_.feet.size(); ++k) {
            const FootPlan& foot = plan_.feet[k];
            if (!plan_.limbs[k].can_reach) continue;
            RetargetState::Stand &heel = state.stands.at(2 * k), &toes = state.stands.at(2 * k + 1);
            FootContact contact = contacts ? FootContact{} : find_contact(plan_, foot, source_, toes.weight);
            contact.heel = weight_of(static_cast<Contact>(2 * k), contacts, contact.heel);
            contact.toes = weight_of(static_cast<Contact>(2 * k + 1), contacts, contact.toes);
            plant(k, foot, contact, heel, toes);
        }
        for (std::size_t k = 0; k < plan_.hands.size() && plan_.is_human; ++k) {
            FootPlan hand = plan_.hands.at(k);
            if (!lay_hand(plan_.feet.size() + k, hand)) continue;
            const std::size_t number = static_cast<std::size_t>(Contact::left_hand) + k;
            RetargetState::Stand none;
            FootContact contact = contacts ? FootContact{} : find_contact(plan_, hand, source_, 0.0f);
            contact.heel = weight_of(static_cast<Contact>(number), contacts, contact.heel);
            plant(plan_.feet.size() + k, hand, contact, state.stands.at(number), none);
        }
        for (std::size_t k = 0; k < plan_.limbs.size() && lying_ > 0.0; ++k) raise_end(k);
    }

    /// Hands that are near each other are as near on the target, in arm lengths, although its shoulders may be broader.
    void join_hands(const std::optional<ContactWeights>& contacts) {
        constexpr double kTogether = 0.25, kApart = 0.5;   // arm lengths
        constexpr double kSomewhat = 0.3, kClearly = 0.6;  // sines: straighter arms turn right round for little
        const std::size_t left = plan_.feet.size(), right = left + 1;
        if (!may_join(plan_.limbs[left]) || !may_join(plan_.limbs[right])) return;
        const auto source_hand = [&](std::size_t k) {
            return glm::dvec3(source_.fresh_matrix(plan_.hands.at(k).heel.source)[3]);
        };
        const glm::dvec3 way = source_hand(1) - source_hand(0);
        const double bent = std::min(bend_of(plan_.limbs[left]), bend_of(plan_.limbs[right]));
        const double near = eased(glm::length(way) / plan_.source_arm, kTogether, kApart);
        const auto found = static_cast<float>(near * smooth(bent, kSomewhat, kClearly));
        const double weight = weight_of(Contact::hands, contacts, found);
        if (!(weight > 0.0)) return;
        LimbFrame &from = limbs_.at(left), &to = limbs_.at(right);
        const double scale = plan_.limbs[left].length / plan_.source_arm;
        const glm::dvec3 off = plan_.map.turn * (scale * way) - (to.wanted + to.below - from.wanted - from.below);
        for (const auto& [limb, share] : {std::pair(&from, -0.5), std::pair(&to, 0.5)}) {
            limb->wanted += share * weight * (1.0 - limb->planted) * off;
            limb->joined = weight;
        }
    }

    /// A hard limit would stop an arm on its way to the other one, and let it go with a jump.
    [[nodiscard]] bool may_join(const LimbPlan& plan) const { return plan.can_reach && !obeys_limits(plan); }

    /// Returns the sine of the angle by which a limb is bent.
    [[nodiscard]] double bend_of(const LimbPlan& plan) const {
        const glm::dvec3 upper = place(plan.lower) - place(plan.upper), lower = place(plan.end) - place(plan.lower);
        const double lengths = glm::length(upper) * glm::length(lower);
        return lengths > 0.0 ? glm::length(glm::cross(upper, lower)) / lengths : 0.0;
    }

    /// Hands and feet of who lies are not below the ground.
    void raise_end(std::size_t number) {
        const LimbPlan& plan = plan_.limbs[number];
        LimbFrame& limb = limbs_.at(number);
        if (!plan.can_reach || plan_.surface.ends.at(number).shares.empty()) return;
        const double moved = glm::dot(plan_.up, limb.wanted - place(plan.end));
        const double below = -height_of(plan_.surface.ends.at(number)) - moved;
        if (!(below > 0.0)) return;
        limb.wanted += lying_ * below * plan_.up;
        limb.planted = std::max(limb.planted, lying_);
    }

    /// Finds how high the wrist is when the hand, as it is turned now, lies on the ground.
    bool lay_hand(std::size_t number, FootPlan& hand) {
        SurfacePart &from = plan_.source_surface.ends.at(number), &to = plan_.surface.ends.at(number);
        const LimbPlan& limb = plan_.limbs[number];
        if (!limb.can_reach || from.shares.empty() || to.shares.empty()) return false;
        const glm::dvec3 source_wrist(source_.fresh_matrix(hand.heel.source)[3]);
        const double height = source_height(from);
        hand.heel.rest_height = glm::dot(plan_.source_up, source_wrist - plan_.map.from) - height;
        const double above = glm::dot(plan_.up, place(limb.foot)) - height_of(to);  // the wrist above the hand
        hand.heel.lift = above + std::max(height, 0.0) * plan_.map.scale - glm::dot(plan_.up, plan_.map(source_wrist));
        return true;
    }

    void plant(std::size_t limb, const FootPlan& foot, const FootContact& contact, RetargetState::Stand& heel,
               RetargetState::Stand& toes) {
        const glm::dvec3 ankle = limbs_[limb].wanted + limbs_[limb].below;
        Foot now{ankle};
        if (foot.toes.source != kNone) {
            const glm::dmat4 carrier = to_.fresh_matrix(foot.toes_carrier);
            now.to_toes = glm::dvec3(carrier[3]) - ankle + glm::dmat3(carrier) * foot.toes_at;
        }
        const Standing standing = stand(plan_, foot, source_, now, contact, heel, toes);
        limbs_[limb].wanted = standing.ankle - limbs_[limb].below;
        limbs_[limb].planted = standing.weight;
    }

    /// Returns how firmly something stands on the ground, and writes it into the result.
    float weight_of(Contact contact, const std::optional<ContactWeights>& given, float found) {
        const auto number = static_cast<std::size_t>(contact);
        return result_.contacts.at(number) = given ? fraction((*given).at(number)) : found;
    }

    /// NaN counts as 0. A foot that is nearly in the air would still be drawn to where it stood before.
    static float fraction(float weight) {
        if (!(weight > kContactRounding)) return 0.0f;
        return weight < 1.0f - kContactRounding ? weight : 1.0f;
    }

    /// Constrains the joints from the trunk outwards. What a limit holds back, the joints below make up for: a hand
    /// keeps its orientation in space even if the elbow cannot turn.
    void constrain_all() {
        for (std::size_t k = 0; k < plan_.moved.size(); ++k) constrain_moved(k);
        for (const Constraint* constraint : plan_.other_constraints) (void)constrain(*constraint);
        place_detached(plan_, to_);
    }

    void constrain_moved(std::size_t number) {
        const MovedJoint& moved = plan_.moved[number];
        const bool is_held = moved.carrier != kNone && plan_.held[moved.carrier] != kNoTurn;
        glm::dquat& held = plan_.held[number];
        held = kNoTurn;
        const double twist = moved.limb == kNone ? 0.0 : twist_for_lower(plan_.limbs[moved.limb]);
        if (!is_held && moved.constraint == nullptr && twist == 0.0) return;
        const glm::dquat wanted = plan_.turns[moved.turn] * moved.after;
        const glm::dquat space = moved.above == kNone ? glm::conjugate(moved.before)
                                                      : plan_.turns[moved.above] * glm::conjugate(moved.before);
        const glm::dquat actual_space = is_held ? plan_.held[moved.carrier] * space : space;
        if (is_held) to_.set_rotation(moved.joint, glm::quat(glm::normalize(glm::conjugate(actual_space) * wanted)));
        if (twist != 0.0) {
            const glm::dquat turned = glm::dquat(to_.local_of(moved.joint).rotation) *
                                      from_vector(twist * plan_.limbs[moved.limb].upper_bone);
            to_.set_rotation(moved.joint, glm::quat(glm::normalize(turned)));
        }
        const double outside = moved.constraint == nullptr ? 0.0 : constrain_far(moved);
        if (outside == 0.0 && twist == 0.0) return;
        held = glm::normalize(actual_space * glm::dquat(to_.local_of(moved.joint).rotation) * glm::conjugate(wanted));
    }

    /// Returns the angle by which the joint was turned back, radians.
    double constrain_far(const MovedJoint& moved) {
        const glm::dquat before(to_.local_of(moved.joint).rotation);
        const double outside = constrain(*moved.constraint);
        if (outside > kFarBeyond) relax(*moved.constraint, before);
        return outside;
    }

    /// Returns by what the upper bone is to turn about itself, so that the lower one can point to where the source's
    /// does: an elbow bends to one side only. 0 if it can point there, or is nearly straight.
    double twist_for_lower(const LimbPlan& limb) {
        if (limb.lower_side == glm::dvec3(0.0)) return 0.0;
        const JointTransform before = to_.local_of(limb.lower);
        const glm::dvec3 wanted = glm::dquat(before.rotation) * limb.lower_bone;
        const glm::dvec3 across = wanted - limb.upper_bone * glm::dot(wanted, limb.upper_bone);
        const double bent = glm::length(across);
        if (!(bent > kBent[0])) return 0.0;
        (void)constrain_joint(pose_, *plan_.target.constraint(limb.lower), Legal::quick);
        const glm::dvec3 legal = glm::dquat(to_.local_of(limb.lower).rotation) * limb.lower_bone;
        to_.set_local(limb.lower, before);
        const double off = glm::length(legal - wanted);
        const double angle = trig::atan2(glm::dot(limb.upper_bone, glm::cross(limb.lower_side, across)),
                                         glm::dot(limb.lower_side, across));
        const double share = smooth(bent, kBent[0], kBent[1]) * (1.0 - smooth(std::abs(angle), kBehind[0], kBehind[1]));
        return angle * share * off * off / (off * off + kSlack * kSlack);
    }

    /// A forearm or a shin that is to turn about its own axis far beyond the limits of the elbow or knee would jump
    /// from one end to the other, where both are equally near. So the farther beyond, the nearer to rest is its turn.
    void relax(const Constraint& constraint, const glm::dquat& wanted) {
        const auto limb = std::find_if(plan_.limbs.begin(), plan_.limbs.end(),
                                       [&](const LimbPlan& one) { return one.lower == constraint.joint; });
        if (limb == plan_.limbs.end() || plan_.target.parents()[limb->end] != limb->lower) return;
        const glm::dvec3 bone(to_.local_of(limb->end).translation);
        if (!(glm::dot(bone, bone) > 0.0)) return;
        const glm::dvec3 axis = glm::normalize(bone);
        const glm::dquat back = glm::conjugate(glm::dquat(plan_.target.joints()[constraint.joint].rest.rotation));
        const auto turn_of = [&](const glm::dquat& rotation) {
            const glm::dquat turn = back * rotation;
            return 2.0 * trig::atan2(glm::dot(glm::dvec3(turn.x, turn.y, turn.z), axis), turn.w);
        };
        const glm::dquat now(to_.local_of(constraint.joint).rotation);
        const double turn = std::remainder(turn_of(now), kFullTurn);
        const double beyond = std::abs(std::remainder(turn_of(wanted) - turn, kFullTurn));
        if (beyond <= kFarBeyond) return;
        const double share = std::min(1.0, (beyond - kFarBeyond) / (kMostBeyond - kFarBeyond));
        to_.set_rotation(constraint.joint, glm::quat(glm::normalize(now * from_vector(-share * turn * axis))));
        (void)constrain(constraint);
    }

    /// Returns true if a constraint is only a guess, beyond which a joint may go.
    [[nodiscard]] bool is_soft(const Constraint& constraint) const {
        return plan_.options.limits == Limits::soft && (constraint.record.flags & kProposed) != 0;
    }

    /// Returns the angle by which the joint was turned back, radians.
    double constrain(const Constraint& constraint) {
        const glm::dquat before(to_.local_of(constraint.joint).rotation);
        double outside = constrain_joint(pose_, constraint, Legal::quick);
        if (outside > 0.0 && is_soft(constraint)) {
            const double kept = 1.0 / (1.0 + outside / kSoftLimit);  // of the angle
            const glm::dquat legal(to_.local_of(constraint.joint).rotation);
            to_.set_rotation(constraint.joint, glm::quat(between(legal, glm::normalize(before), kept)));
            outside *= 1.0 - kept;
        }
        const auto angle = static_cast<float>(outside);
        if (angle > result_.turned) {
            result_.turned = angle;
            result_.turned_joint = constraint.joint;
        }
        return angle;
    }

    /// Lowers the hips until the feet that stand on the ground are within reach.
    void lower_hips() {
        double lowered = 0.0;
        for (std::size_t k = 0; k < plan_.feet.size(); ++k) {
            if (limbs_[k].planted > 0.0) lowered = std::max(lowered, lowering_for(plan_.limbs[k], limbs_[k]));
        }
        lowered *= 1.0 - lying_;
        if (!(lowered > 0.0) || plan_.hips.joint == kNone) return;
        const glm::dvec3 shift = -lowered * plan_.up;
        move_hips(shift);
        for (LimbFrame& limb : limbs_) {
            limb.wanted += (1.0 - limb.planted) * shift;
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

    /// Only feet that stand reach: everything else keeps its direction as far as limits allow.
    void finish(const LimbPlan& plan, const LimbFrame& limb) {
        constexpr double kThere = 1e-5;  // of the length
        double missed = distance_left(plan, limb);
        if ((limb.planted > 0.0 || limb.joined > 0.0) && missed > kThere * plan.length)
            missed = try_to_reach(plan, limb, missed);
        if (missed <= double{result_.missed}) return;
        result_.missed = static_cast<float>(missed);
        result_.missed_joint = plan.foot;
    }

    [[nodiscard]] double distance_left(const LimbPlan& plan, const LimbFrame& limb) const {
        return glm::length(place(plan.foot) - (limb.wanted + limb.below));
    }

    /// Leaves a leg as it is if it cannot come nearer within the limits, or only turned over; an arm goes back as far
    /// as it cannot. Returns the distance that is left.
    double try_to_reach(const LimbPlan& plan, const LimbFrame& limb, double distance) {
        const std::array joints{plan.upper, plan.lower, plan.end};
        std::array<JointTransform, joints.size()> before;
        for (std::size_t k = 0; k < joints.size(); ++k) before[k] = to_.local_of(joints[k]);
        if (plan.is_arm) {
            reach_for(plan, limb, Solver::two_bone);
            const double share = 1.0 - smooth(distance_left(plan, limb) / distance, kWorth[0], kWorth[1]);
            for (std::size_t k = 0; k < joints.size() && share < 1.0; ++k) go_back(joints[k], before[k], share);
            return distance_left(plan, limb);
        }
        // Where limits stop the two-bone solver, it turns a leg over; least squares go on from its pose.
        for (const Solver solver : {Solver::two_bone, Solver::least_squares}) {
            reach_for(plan, limb, solver);
            const double left = distance_left(plan, limb);
            const bool is_over = is_turned_over(plan);
            if (left <= distance && !is_over) return left;
            for (std::size_t k = 0; k < joints.size(); ++k) to_.set_local(joints[k], before[k]);
            if (!is_over) break;
        }
        return distance;
    }

    /// Undoes part of a joint's turn. \param share  of the turn that is kept, 0 to 1
    void go_back(std::uint32_t joint, const JointTransform& before, double share) {
        const Constraint* const limit = plan_.options.limits == Limits::off ? nullptr : plan_.target.constraint(joint);
        const glm::quat& rest = plan_.target.joints()[joint].rest.rotation;
        to_.set_rotation(joint, turn_part_way(limit, rest, before.rotation, to_.local_of(joint).rotation, share));
    }

    /// Returns true if solvers obey the limits of a limb: not where all are soft.
    [[nodiscard]] bool obeys_limits(const LimbPlan& plan) const {
        if (plan_.options.limits != Limits::soft) return plan_.options.limits == Limits::hard;
        const std::array joints{plan.upper, plan.lower, plan.end};
        return std::any_of(joints.begin(), joints.end(), [&](std::uint32_t joint) {
            const std::uint32_t number = to_.data->ik_constraint(joint);
            return number != kNone && !is_soft(to_.data->constraints[number]);
        });
    }

    /// Returns true if a constraint limits knee or elbow while a solver works.
    [[nodiscard]] bool has_limits(const LimbPlan& plan) const {
        return obeys_limits(plan) && to_.data->ik_constraint(plan.lower) != kNone;
    }

    /// Returns true if an animal's leg is bent to the wrong side, which wide limits allow.
    [[nodiscard]] bool is_turned_over(const LimbPlan& plan) const {
        if (plan_.is_human || !has_limits(plan)) return false;
        constexpr double kClearly = 0.03;  // of the length
        const glm::dvec3 start = place(plan.upper), way = place(plan.end) - start, middle = place(plan.lower) - start;
        const glm::dvec3 bend = glm::dmat3(to_.fresh_matrix(plan.upper)) * plan.bend;
        const double length = glm::dot(way, way);
        if (!(length > 0.0)) return false;
        return glm::dot(middle - way * (glm::dot(middle, way) / length), glm::normalize(bend)) <
               -kClearly * plan.length;
    }

    /// Bends a limb that is straight, or a leg that is bent to the wrong side, a little to the side that it bends to,
    /// so that a solver continues from there. Turns neither of its bones about its axis.
    void bend_a_little(const LimbPlan& plan, const LimbFrame& limb) {
        constexpr double kLeast = 0.03;  // of the length
        const glm::dvec3 start = place(plan.upper), middle = place(plan.lower), end = place(plan.end);
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
        turn_joint(plan.upper, upper);
        turn_joint(plan.lower, between(upper * (end - middle), end - moved));
    }

    /// Turns a joint with all below it in model space.
    void turn_joint(std::uint32_t joint, const glm::dquat& turn) {
        const glm::dquat space = rigid_rotation(to_.fresh_matrix(plan_.target.parents()[joint]));
        const glm::dquat local = glm::conjugate(space) * turn * space * glm::dquat(to_.local_of(joint).rotation);
        to_.set_rotation(joint, glm::quat(glm::normalize(local)));
    }

    void reach_for(const LimbPlan& plan, const LimbFrame& limb, Solver solver) {
        const Chain& chain = plan.chain != nullptr ? *plan.chain : plan.own;
        ReachOptions options;
        options.solver = solver;
        // An arm reaches freely and is then moved inside its limits, so that it does not jump where they stop it.
        options.obey_constraints = obeys_limits(plan) && !plan.is_arm;
        // Without a pole the solver keeps the plane in which a limb is bent.
        options.softness = 0.0f;
        options.restarts = 0;
        // A knee with limits knows where it bends to.
        if (!has_limits(plan)) bend_a_little(plan, limb);
        const ReachTarget target{glm::vec3(limb.wanted)};
        const bool is_reached = solver == Solver::two_bone && reach_quickly(chain, target, pose_, options);
        if (!is_reached) (void)reach_at_length(chain, target, pose_, options);
        place_detached(plan_, to_);
        const glm::dquat space = rigid_rotation(to_.fresh_matrix(plan_.target.parents()[plan.end]));
        to_.set_rotation(plan.end, glm::quat(glm::normalize(glm::conjugate(space) * limb.turn)));
        if (plan_.options.limits == Limits::off) return;
        for (const std::uint32_t joint : {plan.upper, plan.lower, plan.end}) {
            const Constraint* constraint = plan_.target.constraint(joint);
            // Soft limits have acted on the arm already; a short reach does not call for them again.
            if (constraint != nullptr && !(plan.is_arm && is_soft(*constraint))) (void)constrain(*constraint);
        }
    }

    RetargetPlan& plan_;
    PoseState& source_;
    Pose& pose_;
    PoseState& to_;
    std::array<LimbFrame, kMostLimbs> limbs_{};
    double lying_ = 0.0;                                            ///< how firmly the body is on the ground
    double body_height_ = std::numeric_limits<double>::infinity();  ///< metres, as the source's: infinite if unknown
    Retargeted result_;
};

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
    return Settling(plan, source, pose).run(state, contacts);
}

}  // namespace bendy
