#include "foot_planting.h"

#include "math/smooth.h"
#include "pose/pose_state.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace bendy {
namespace {

/// Returns how far a point of the source is above where it is at rest, in leg lengths.
double height_of(const RetargetPlan& plan, const ContactPlan& contact, PoseState& source) {
    const glm::dvec3 place(source.fresh_matrix(contact.source)[3]);
    return (glm::dot(plan.source_up, place - plan.map.from) - contact.rest_height) / plan.source_leg;
}

/// Returns the foot's turn about the vertical since rest, in the target's model space.
glm::dquat heading_of(const RetargetPlan& plan, const FootPlan& foot) {
    const glm::dquat turn = plan.turns[foot.turn] * foot.rest;
    const double about_up = glm::dot(glm::dvec3(turn.x, turn.y, turn.z), plan.source_up);
    const glm::dquat heading(turn.w, about_up * plan.up);
    const double length = glm::length(heading);
    return length > 1e-6 ? heading / length : glm::dquat(1.0, 0.0, 0.0, 0.0);
}

/// Where points of a foot are to be, in the axes of the ground.
class Ground {
public:
    Ground(const RetargetPlan& plan, const FootPlan& foot, PoseState& source)
        : plan_(plan), source_(source), heading_(heading_of(plan, foot)) {}

    /// Returns the place of the source's point in the target's space, at its height above the ground.
    [[nodiscard]] glm::dvec3 mapped(const ContactPlan& contact) const {
        const glm::dvec3 place(source_.fresh_matrix(contact.source)[3]);
        return plan_.map(place) + contact.lift * plan_.up;
    }
    [[nodiscard]] glm::dvec3 shifted(const glm::dvec3& place, const RetargetState::Stand& stand) const {
        return place + heading_ * glm::dvec3(stand.offset);
    }
    /// Remembers where a point is beside its mapped place.
    void remember(RetargetState::Stand& stand, const glm::dvec3& place, const glm::dvec3& mapped) const {
        const glm::dvec3 offset = place - mapped;
        stand.offset = glm::vec3(glm::conjugate(heading_) * (offset - plan_.up * glm::dot(plan_.up, offset)));
    }

private:
    const RetargetPlan& plan_;
    PoseState& source_;
    glm::dquat heading_;
};

}  // namespace

float eased(double number, double low, double high) {
    return static_cast<float>(smooth(number, high, low));
}

FootContact find_contact(const RetargetPlan& plan, const FootPlan& foot, PoseState& source, float last_toes) {
    constexpr double kHeelStands = 0.04, kHeelLeft = 0.15;  // leg lengths
    constexpr double kToesStand = 0.03, kToesLeft = 0.12;
    FootContact found;
    found.heel = eased(height_of(plan, foot.heel, source), kHeelStands, kHeelLeft);
    if (foot.toes.source == kNone) return found;
    const float toes = eased(height_of(plan, foot.toes, source), kToesStand, kToesLeft);
    found.toes = std::min(toes, std::max(found.heel, last_toes));
    return found;
}

float body_contact(double height, double above_feet) {
    constexpr double kLies = 0.12, kInAir = 0.3;    // leg lengths
    constexpr double kSits = 0.25, kStands = 0.45;  // leg lengths above the feet
    constexpr double kSinks = 0.5, kElsewhere = 1;  // leg lengths below the ground
    return eased(height, kLies, kInAir) * eased(above_feet, kSits, kStands) * eased(-height, kSinks, kElsewhere);
}

Standing stand(const RetargetPlan& plan, const FootPlan& plan_of_foot, PoseState& source, const Foot& foot,
               const FootContact& contact, RetargetState::Stand& heel, RetargetState::Stand& toes) {
    Standing standing{foot.ankle, 0.0};
    const Ground ground(plan, plan_of_foot, source);
    if (contact.toes > 0.0f && plan_of_foot.toes.source != kNone) {
        const glm::dvec3 mapped = ground.mapped(plan_of_foot.toes);
        if (toes.weight == 0.0f) ground.remember(toes, foot.ankle + foot.to_toes, mapped);
        const glm::dvec3 wanted = ground.shifted(mapped, toes) - foot.to_toes;
        standing = {glm::mix(standing.ankle, wanted, double{contact.toes}), contact.toes};
    }
    if (contact.heel > 0.0f) {
        const glm::dvec3 mapped = ground.mapped(plan_of_foot.heel);
        if (heel.weight == 0.0f) ground.remember(heel, standing.ankle, mapped);
        const double weight = contact.heel;
        standing.ankle = glm::mix(standing.ankle, ground.shifted(mapped, heel), weight);
        standing.weight += (1.0 - standing.weight) * weight;
        if (contact.heel == 1.0f && plan_of_foot.toes.source != kNone)
            ground.remember(toes, standing.ankle + foot.to_toes, ground.mapped(plan_of_foot.toes));
    }
    heel.weight = contact.heel;
    toes.weight = contact.toes;
    // Who lies or sits may be built so differently that a foot cannot be where it would be: it keeps its direction
    // then, but does not sink into the ground. Legs of animals differ more: a horse's upper arm is short and slanted.
    const double kept = plan.is_human ? 0.12 : 0.3, lost = plan.is_human ? 0.3 : 0.6;  // leg lengths
    glm::dvec3 off = standing.ankle - foot.ankle;
    off -= std::max(0.0, glm::dot(off, plan.up)) * plan.up;
    const double share = eased(glm::length(off) / plan.leg, kept, lost);
    return {glm::mix(foot.ankle, standing.ankle, share), share * standing.weight};
}

}  // namespace bendy
