#include "plant_contacts.h"

#include "foot_planting.h"
#include "settle.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace bendy {
namespace {

constexpr float kContactRounding = 0.005f;  // of given that are given: curves leave out keys

/// Returns the height above the ground of the source's or the target's lowest point, metres.
double source_height(SettledFrame& frame, SurfacePart& part) {
    return part.lowest(frame.source, frame.plan.source_up) - frame.plan.source_surface.floor;
}

double height_of(SettledFrame& frame, SurfacePart& part) {
    return part.lowest(frame.to, frame.plan.up) - frame.plan.surface.floor;
}

/// Moves the hips with all below them, in model space.
void move_hips(SettledFrame& frame, const glm::dvec3& shift) {
    const std::uint32_t parent = frame.plan.target.parents()[frame.plan.hips.joint];
    const glm::dmat3 space(frame.to.fresh_matrix(parent));
    if (!(std::abs(glm::determinant(space)) > 1e-30)) return;
    JointTransform local = frame.to.local_of(frame.plan.hips.joint);
    local.translation += glm::vec3(glm::inverse(space) * shift);
    frame.to.set_local(frame.plan.hips.joint, local);
    place_detached(frame.plan, frame.to);
}

/// NaN counts as 0. A foot that is nearly in the air would still be drawn to where it stood before.
float fraction(float weight) {
    if (!(weight > kContactRounding)) return 0.0f;
    return weight < 1.0f - kContactRounding ? weight : 1.0f;
}

/// Returns the shift.
glm::dvec3 shift_body(SettledFrame& frame) {
    const double now = height_of(frame, frame.plan.surface.body);
    const double laid = std::max(std::max(frame.body_height, 0.0) - now, -height_of(frame, frame.plan.surface.arms));
    const double sunk = std::min(frame.body_height, 0.0) - now;  // who crouches does not sink, either
    const double shift = std::max(frame.lying * laid, sunk);
    if (!(frame.lying > 0.0) && !(shift > 0.0)) return glm::dvec3(0.0);
    move_hips(frame, shift * frame.plan.up);
    return shift * frame.plan.up;
}

/// Hands and feet of who lies are not below the ground.
void raise_end(SettledFrame& frame, std::size_t number) {
    const LimbPlan& plan = frame.plan.limbs[number];
    LimbFrame& limb = frame.limbs.at(number);
    if (!plan.can_reach || frame.plan.surface.ends.at(number).shares.empty()) return;
    const double moved = glm::dot(frame.plan.up, limb.wanted - frame.place(plan.end));
    const double below = -height_of(frame, frame.plan.surface.ends.at(number)) - moved;
    if (!(below > 0.0)) return;
    limb.wanted += frame.lying * below * frame.plan.up;
    limb.planted = std::max(limb.planted, frame.lying);
}

/// Finds how high the wrist is when the hand, as it is turned now, lies on the ground.
bool lay_hand(SettledFrame& frame, std::size_t number, FootPlan& hand) {
    SurfacePart &from = frame.plan.source_surface.ends.at(number), &to = frame.plan.surface.ends.at(number);
    const LimbPlan& limb = frame.plan.limbs[number];
    if (!limb.can_reach || from.shares.empty() || to.shares.empty()) return false;
    const glm::dvec3 source_wrist(frame.source.fresh_matrix(hand.heel.source)[3]);
    const double height = source_height(frame, from);
    hand.heel.rest_height = glm::dot(frame.plan.source_up, source_wrist - frame.plan.map.from) - height;
    const double above =
        glm::dot(frame.plan.up, frame.place(limb.foot)) - height_of(frame, to);  // the wrist above the hand
    hand.heel.lift =
        above + std::max(height, 0.0) * frame.plan.map.scale - glm::dot(frame.plan.up, frame.plan.map(source_wrist));
    return true;
}

void plant(SettledFrame& frame, std::size_t limb, const FootPlan& foot, const FootContact& contact,
           RetargetState::Stand& heel, RetargetState::Stand& toes) {
    const glm::dvec3 ankle = frame.limbs[limb].wanted + frame.limbs[limb].below;
    Foot now{ankle};
    if (foot.toes.source != kNone) {
        const glm::dmat4 carrier = frame.to.fresh_matrix(foot.toes_carrier);
        now.to_toes = glm::dvec3(carrier[3]) - ankle + glm::dmat3(carrier) * foot.toes_at;
    }
    const Standing standing = stand(frame.plan, foot, frame.source, now, contact, heel, toes);
    frame.limbs[limb].wanted = standing.ankle - frame.limbs[limb].below;
    frame.limbs[limb].planted = standing.weight;
}

double lowering_for(SettledFrame& frame, const LimbPlan& plan, const LimbFrame& limb) {
    constexpr double kNearlyStraight = 0.995;  // of the length
    constexpr double kMost = 0.1;              // of the length
    const double reach = std::clamp(limb.extended, kNearlyStraight * plan.length, plan.length);
    const glm::dvec3 way = frame.place(plan.upper) - limb.wanted;
    const double height = glm::dot(way, frame.plan.up);
    const double across = glm::dot(way, way) - height * height;
    if (across + height * height <= reach * reach) return 0.0;
    const double left = reach * reach - across;
    const double lowered = left > 0.0 ? height - std::sqrt(left) : kMost * plan.length;
    return limb.planted * std::clamp(lowered, 0.0, kMost * plan.length);
}

}  // namespace

float weight_of(SettledFrame& frame, Contact contact, const GivenContacts& given, float found) {
    const auto number = static_cast<std::size_t>(contact);
    return frame.result.contacts.at(number) = given ? fraction((*given).at(number)) : found;
}

void lay_body(SettledFrame& frame, const GivenContacts& given) {
    Surface &from = frame.plan.source_surface, &to = frame.plan.surface;
    if (from.body.shares.empty() || to.body.shares.empty() || frame.plan.hips.joint == kNone) return;
    const double height = source_height(frame, from.body) / frame.plan.source_leg;
    double above_feet = height;
    for (std::size_t k = 0; k < frame.plan.feet.size(); ++k)
        above_feet = std::max(above_feet, height - source_height(frame, from.ends.at(k)) / frame.plan.source_leg);
    frame.lying = weight_of(frame, Contact::body, given, body_contact(height, above_feet));
    frame.body_height = height * frame.plan.leg;
    (void)shift_body(frame);
}

void lay_again(SettledFrame& frame) {
    if (!std::isfinite(frame.body_height)) return;
    const glm::dvec3 shift = shift_body(frame);
    for (LimbFrame& limb : frame.limbs) limb.wanted += (1.0 - limb.planted) * shift;
}

void plant_limbs(SettledFrame& frame, RetargetState& state, const GivenContacts& given) {
    for (std::size_t k = 0; k < frame.plan.feet.size(); ++k) {
        const FootPlan& foot = frame.plan.feet[k];
        if (!frame.plan.limbs[k].can_reach) continue;
        RetargetState::Stand &heel = state.stands.at(2 * k), &toes = state.stands.at(2 * k + 1);
        FootContact contact = given ? FootContact{} : find_contact(frame.plan, foot, frame.source, toes.weight);
        contact.heel = weight_of(frame, static_cast<Contact>(2 * k), given, contact.heel);
        contact.toes = weight_of(frame, static_cast<Contact>(2 * k + 1), given, contact.toes);
        plant(frame, k, foot, contact, heel, toes);
    }
    for (std::size_t k = 0; k < frame.plan.hands.size() && frame.plan.is_human; ++k) {
        FootPlan hand = frame.plan.hands.at(k);
        if (!lay_hand(frame, frame.plan.feet.size() + k, hand)) continue;
        const std::size_t number = static_cast<std::size_t>(Contact::left_hand) + k;
        RetargetState::Stand none;
        FootContact contact = given ? FootContact{} : find_contact(frame.plan, hand, frame.source, 0.0f);
        contact.heel = weight_of(frame, static_cast<Contact>(number), given, contact.heel);
        plant(frame, frame.plan.feet.size() + k, hand, contact, state.stands.at(number), none);
    }
    for (std::size_t k = 0; k < frame.plan.limbs.size() && frame.lying > 0.0; ++k) raise_end(frame, k);
}

void lower_hips(SettledFrame& frame) {
    double lowered = 0.0;
    for (std::size_t k = 0; k < frame.plan.feet.size(); ++k) {
        if (frame.limbs[k].planted > 0.0)
            lowered = std::max(lowered, lowering_for(frame, frame.plan.limbs[k], frame.limbs[k]));
    }
    lowered *= 1.0 - frame.lying;
    if (!(lowered > 0.0) || frame.plan.hips.joint == kNone) return;
    const glm::dvec3 shift = -lowered * frame.plan.up;
    move_hips(frame, shift);
    for (LimbFrame& limb : frame.limbs) {
        limb.wanted += (1.0 - limb.planted) * shift;
    }
    frame.result.lowered = static_cast<float>(lowered);
}

}  // namespace bendy
