#include "body.h"
#include "joint_pairs.h"
#include "retarget_plan.h"
#include "same_rig.h"
#include "target_names.h"

#include "ik/ik_problem.h"
#include "pose/ik_link.h"

#include <bendy/runtime/binding.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <utility>

namespace bendy {
namespace {

class PlanMaker {
public:
    PlanMaker(RetargetPlan& plan, const Body& source, const Body& target)
        : plan_(plan), source_(source), target_(target) {}

    void make() {
        make_map();
        pairs_ = pair_joints(source_, target_, plan_.map.turn, plan_.options.rest_poses);
        for (const JointPair& pair : pairs_) plan_.joints.push_back(pair.a == kNone ? kNone : pair.nearer());
        list_source_joints();
        for (std::uint32_t joint = 0; joint < pairs_.size(); ++joint) {
            if (pairs_[joint].a != kNone) add_moved(joint);
        }
        for (const Constraint& constraint : plan_.target.constraints()) {
            const bool counts = plan_.target.constraint(constraint.joint) == &constraint;
            if (counts && moved_of_[constraint.joint] == kNone) plan_.other_constraints.push_back(&constraint);
        }
        hold_standing();
        plan_.held.resize(plan_.moved.size());
        plan_.turns.resize(plan_.source_joints.size() + plan_.mixed_turns.size());
        make_hips();
        find_detached();
        make_limbs();
        if (plan_.is_human && plan_.options.plants_feet && source_.has_legs() && target_.has_legs()) {
            find_surfaces();
        }
        match_morph_targets();
    }

private:
    static constexpr double kLeast = 1e-9;  // metres: what is shorter has no length

    void make_map() {
        SpaceMap& map = plan_.map;
        map.turn = source_.axes() == target_.axes() ? kNoTurn
                                                    : glm::normalize(target_.axes() * glm::conjugate(source_.axes()));
        plan_.source_up = source_.up();
        plan_.up = target_.up();
        plan_.is_human = target_.kind() == BodyKind::human;
        compare_sizes();
        map.scale = plan_.leg / plan_.source_leg;
        if (source_.lengths().back() > kLeast) plan_.source_arm = source_.lengths().back();
        const bool is_measured = plan_.options.rest_poses == RestPoses::measured;
        if (is_measured && have_hip_joints()) {
            const bool have_legs = source_.has_legs() && target_.has_legs();
            map.from = have_legs ? source_.ground() : source_.hips();
            map.to = have_legs ? target_.ground() : target_.hips();
            return;
        }
        const std::uint32_t source_hips = source_.joint(Role::hips), target_hips = target_.joint(Role::hips);
        if (source_hips == kNone || target_hips == kNone) return;
        if (is_measured) {
            map.from = source_.place(source_hips);
            map.to = target_.place(target_hips);
            return;
        }
        const double from = glm::dot(source_.up(), source_.place(source_hips));
        const double to = glm::dot(target_.up(), target_.place(target_hips));
        if (from > kLeast && to > kLeast) map.scale = to / from;
    }

    [[nodiscard]] bool have_hip_joints() const { return source_.has_hip_joints() && target_.has_hip_joints(); }

    /// Compares the legs or, where one of the two has none, what both have.
    void compare_sizes() {
        for (std::size_t k = 0; k < source_.lengths().size(); ++k) {
            if (!(source_.lengths()[k] > kLeast) || !(target_.lengths()[k] > kLeast)) continue;
            plan_.source_leg = source_.lengths()[k];
            plan_.leg = target_.lengths()[k];
            return;
        }
    }

    void list_source_joints() {
        const auto parents = plan_.source.parents();
        std::vector<bool> is_needed(parents.size());
        const auto need = [&](std::uint32_t joint) {
            for (; joint != kNone && !is_needed[joint]; joint = parents[joint]) is_needed[joint] = true;
        };
        for (const JointPair& pair : pairs_) {
            need(pair.a);
            need(pair.b);
        }
        for (const Limb& limb : source_.limbs()) {
            if (limb.is_whole()) need(limb.foot_joint());
        }
        turn_of_.assign(parents.size(), kNone);
        for (std::uint32_t joint = 0; joint < parents.size(); ++joint) {
            if (!is_needed[joint]) continue;
            turn_of_[joint] = static_cast<std::uint32_t>(plan_.source_joints.size());
            const glm::dquat flip = source_.flip(joint);
            plan_.source_joints.push_back(
                {joint, parents[joint] == kNone ? kNone : turn_of_[parents[joint]], flip != kNoTurn, flip});
        }
        moved_of_.assign(pairs_.size(), kNone);
    }

    [[nodiscard]] std::uint32_t moved_above(std::uint32_t joint) const {
        const auto parents = plan_.target.parents();
        for (joint = parents[joint]; joint != kNone && moved_of_[joint] == kNone;) joint = parents[joint];
        return joint == kNone ? kNone : moved_of_[joint];
    }

    /// Returns the inverse orientation at rest of what a pair turns by: a mixed turn is relative to rest already.
    [[nodiscard]] glm::dquat source_rest(const JointPair& pair) const {
        return pair.b == kNone ? glm::conjugate(source_.turn(pair.a)) : kNoTurn;
    }

    std::uint32_t add_turn(const JointPair& pair) {
        if (pair.b == kNone) return turn_of_[pair.a];
        plan_.mixed_turns.push_back({turn_of_[pair.a], turn_of_[pair.b], glm::conjugate(source_.turn(pair.a)),
                                     glm::conjugate(source_.turn(pair.b)), pair.share});
        return static_cast<std::uint32_t>(plan_.source_joints.size() + plan_.mixed_turns.size() - 1);
    }

    void add_moved(std::uint32_t joint) {
        const JointPair& pair = pairs_[joint];
        const std::uint32_t parent = plan_.target.parents()[joint];
        const std::uint32_t above = moved_above(joint);
        const glm::dquat back = glm::conjugate(plan_.map.turn);
        MovedJoint moved;
        moved.joint = joint;
        moved.source = pair.nearer();
        moved.turn = add_turn(pair);
        moved.after = source_rest(pair) * back * pair.align * target_.turn(joint);
        if (above == kNone) {
            moved.before = glm::conjugate(target_.space(parent)) * plan_.map.turn;
        } else {
            const MovedJoint& carrier = plan_.moved[above];
            const JointPair& carrying = pairs_[carrier.joint];
            moved.above = carrier.turn;
            moved.carrier = above;
            moved.before = glm::conjugate(source_rest(carrying) * back * carrying.align * target_.space(parent));
        }
        moved.is_prop = pair.is_prop;
        if (moved.is_prop) moved.travel = travel_of(moved.source, joint);
        moved.is_copy = is_copy(joint, above);
        moved.constraint = plan_.target.constraint(joint);
        moved_of_[joint] = static_cast<std::uint32_t>(plan_.moved.size());
        plan_.moved.push_back(moved);
    }

    /// Returns true if the joint's numbers mean the same in both models.
    [[nodiscard]] bool is_copy(std::uint32_t joint, std::uint32_t above) const {
        const JointPair& pair = pairs_[joint];
        const SpaceMap& map = plan_.map;
        if (pair.b != kNone || pair.align != kNoTurn || map.turn != kNoTurn || map.scale != 1.0 || map.from != map.to)
            return false;
        const Joint& from = plan_.source.joints()[pair.a];
        const Joint& to = plan_.target.joints()[joint];
        if (from.rest.rotation != to.rest.rotation || from.rest.translation != to.rest.translation ||
            from.rest.scale != to.rest.scale || from.shear != to.shear) {
            return false;
        }
        if (to.parent == kNone || from.parent == kNone) return to.parent == from.parent;
        if (above == kNone) return false;
        const MovedJoint& carrier = plan_.moved[above];
        return carrier.joint == to.parent && carrier.is_copy && carrier.source == from.parent;
    }

    [[nodiscard]] glm::dmat3 travel_of(std::uint32_t from, std::uint32_t to) const {
        const std::uint32_t from_parent = plan_.source.parents()[from];
        const std::uint32_t to_parent = plan_.target.parents()[to];
        const glm::dmat3 out = from_parent == kNone ? glm::dmat3(1.0) : glm::dmat3(source_.rest(from_parent));
        const glm::dmat3 in = to_parent == kNone ? glm::dmat3(1.0) : glm::dmat3(target_.rest(to_parent));
        if (!(std::abs(glm::determinant(in)) > 1e-30)) return glm::dmat3(0.0);
        return glm::inverse(in) * glm::mat3_cast(plan_.map.turn) * out * plan_.map.scale;
    }

    /// Joints that the source does not have stay as they are in the standing pose.
    void hold_standing() {
        if (plan_.options.rest_poses != RestPoses::measured) return;
        for (const StandingJoint& standing : standing_rotations(plan_.target)) {
            if (moved_of_[standing.joint] == kNone) plan_.standing.push_back(standing);
        }
    }

    void make_hips() {
        HipsPlan& hips = plan_.hips;
        const std::uint32_t joint = target_.joint(Role::hips);
        if (joint == kNone || moved_of_[joint] == kNone || plan_.moved[moved_of_[joint]].is_copy) return;
        const glm::dmat4 inverse = glm::inverse(target_.rest(joint));
        if (!std::isfinite(inverse[3].x + inverse[0].x + inverse[1].y + inverse[2].z)) return;
        hips.joint = joint;
        hips.source = {source_.joint(Role::hips), source_.joint(Role::hips)};
        if (plan_.options.rest_poses == RestPoses::measured && have_hip_joints()) {
            const std::vector<Limb>& limbs = target_.limbs();
            hips.source = {source_.limbs()[0].upper(), source_.limbs()[1].upper()};
            hips.middle = 0.5 * (place_in(joint, limbs[0].upper()) + place_in(joint, limbs[1].upper()));
        }
        const auto parents = plan_.target.parents();
        for (std::uint32_t above = parents[joint]; above != kNone; above = parents[above]) hips.above.push_back(above);
        std::reverse(hips.above.begin(), hips.above.end());
    }

    /// Joints of the body that hang on something else, as on controls of a rig, stay where they are on their carrier.
    void find_detached() {
        const std::uint32_t hips = target_.joint(Role::hips);
        if (plan_.is_human) find_detached_trunk(hips);
        for (std::size_t k = 0; k < target_.limbs().size(); ++k) {
            const Limb& limb = target_.limbs()[k];
            if (k < 2 && !limb.joints.empty()) add_detached(hips, limb.upper());
            for (std::size_t j = 1; j < limb.joints.size(); ++j) add_detached(limb.joints[j - 1], limb.joints[j]);
        }
    }

    void find_detached_trunk(std::uint32_t hips) {
        std::vector<std::uint32_t> body{hips};
        const auto follow = [&](std::uint32_t carrier, std::initializer_list<Role> roles) {
            for (const std::uint32_t joint : target_.joints(roles)) {
                const bool is_carried = std::any_of(body.begin(), body.end(),
                                                    [&](std::uint32_t one) { return links_between(one, joint) != 0; });
                if (!is_carried) add_detached(carrier, joint);
                body.push_back(joint);
                carrier = joint;
            }
            return carrier;
        };
        const std::uint32_t chest = follow(hips, {Role::spine, Role::chest, Role::upper_chest});
        follow(chest, {Role::neck, Role::head});
        follow(chest, {Role::left_shoulder, Role::left_upper_arm});
        follow(chest, {Role::right_shoulder, Role::right_upper_arm});
    }

    void add_detached(std::uint32_t carrier, std::uint32_t joint) {
        if (carrier == kNone || links_between(carrier, joint) != 0) return;
        if (moved_of_[joint] != kNone && plan_.moved[moved_of_[joint]].is_copy) return;
        plan_.detached.push_back({joint, carrier, place_in(carrier, joint)});
    }

    /// Returns where a joint of the target is at rest, in the space of another one.
    [[nodiscard]] glm::dvec3 place_in(std::uint32_t space, std::uint32_t joint) const {
        return {glm::inverse(target_.rest(space)) * glm::dvec4(target_.place(joint), 1.0)};
    }

    void make_limbs() {
        const glm::dvec3 ahead = target_.axes() * glm::dvec3(0.0, 0.0, 1.0);
        plan_.limbs.resize(target_.limbs().size());
        for (std::size_t k = 0; k < plan_.limbs.size(); ++k) {
            const Limb& limb = target_.limbs()[k];
            FootPlan* const foot = limb.is_leg ? &plan_.feet.emplace_back() : nullptr;
            if (!limb.is_whole() || !source_.limbs()[k].is_whole()) continue;
            make_limb(plan_.limbs[k], source_.limbs()[k], limb, k < 2 ? ahead : -ahead);
            const std::uint32_t upper = moved_of_[plan_.limbs[k].upper];
            if (upper != kNone) plan_.moved[upper].limb = static_cast<std::uint32_t>(k);
            if (foot != nullptr) make_foot(*foot, source_.limbs()[k], limb);
            plan_.limbs[k].is_arm = foot == nullptr;
            if (foot == nullptr) make_hand(plan_.hands.at(k - plan_.feet.size()), source_.limbs()[k].foot_joint());
        }
    }

    /// Returns the number of joints from one down to another, both included; 0 if the second is not below.
    [[nodiscard]] std::uint32_t links_between(std::uint32_t upper, std::uint32_t end) const {
        const auto parents = plan_.target.parents();
        std::uint32_t links = 1;
        for (; end != kNone && end != upper; end = parents[end]) ++links;
        return end == kNone ? 0 : links;
    }

    /// Returns the way from the line between a limb's ends to its middle at rest; zero if it is nearly straight.
    static glm::dvec3 bend_of(const Body& body, const Limb& limb) {
        constexpr double kBent = 0.05;  // of the length
        const glm::dvec3 middle = body.place(limb.joints[1]) - body.place(limb.joints[0]);
        const glm::dvec3 way = body.place(limb.joints[2]) - body.place(limb.joints[0]);
        const double square = glm::dot(way, way);
        const glm::dvec3 bend = square > 0.0 ? middle - way * (glm::dot(middle, way) / square) : middle;
        const double length = glm::length(middle) + glm::length(way - middle);
        return glm::length(bend) > kBent * length ? bend : glm::dvec3(0.0);
    }

    /// \param side  to which a straight limb bends
    void make_limb(LimbPlan& limb, const Limb& from, const Limb& of, const glm::dvec3& side) {
        limb.upper = of.joints[0];
        limb.lower = of.joints[1];
        limb.end = of.joints[2];
        limb.foot = of.foot_joint();
        const glm::dvec3 start = target_.place(limb.upper);
        const glm::dvec3 middle = target_.place(limb.lower);
        const glm::dvec3 end = target_.place(limb.end);
        limb.length = glm::length(middle - start) + glm::length(end - middle);
        glm::dvec3 bend = bend_of(target_, of);
        if (bend == glm::dvec3(0.0)) bend = side;
        // Legs of animals may be counted from shoulder or elbow, and so bend as the source's.
        const glm::dvec3 of_source = source_.axes() * (glm::conjugate(target_.axes()) * bend);
        if (!plan_.is_human && glm::dot(bend_of(source_, from), of_source) < 0.0) bend = -bend;
        limb.bend = glm::conjugate(target_.turn(limb.upper)) * glm::normalize(bend);
        const bool is_detached = links_between(limb.lower, limb.end) == 0;
        const std::uint32_t tip = is_detached ? limb.lower : limb.end;
        const std::uint32_t links = links_between(limb.upper, tip);
        const std::uint32_t plain = is_detached ? kLimbLinks - 1 : kLimbLinks;
        for (const Chain& chain : plan_.target.chains()) {
            if (links != plain && chain.record.start == limb.upper && chain.record.effector == tip) limb.chain = &chain;
        }
        limb.own.record.start = limb.upper;
        limb.own.record.effector = tip;
        limb.own.links = links;
        limb.own.record.solver = static_cast<std::uint8_t>(Solver::two_bone);
        if (is_detached) {
            const glm::vec3 place(place_in(limb.lower, limb.end));
            limb.own.record.tip_offset = {place.x, place.y, place.z};
        }
        find_lower_side(limb);
        const bool has_middle = links_between(limb.upper, limb.lower) != 0;
        limb.can_reach = has_middle && limb.length > 0.0 && (links == plain || limb.chain != nullptr);
    }

    void find_lower_side(LimbPlan& limb) const {
        const Constraint* const limit = plan_.target.constraint(limb.lower);
        if (limit == nullptr || plan_.target.parents()[limb.lower] != limb.upper) return;
        limb.upper_bone = direction(place_in(limb.upper, limb.lower));
        limb.lower_bone = direction(place_in(limb.lower, limb.end));
        const glm::dquat rest(plan_.target.joints()[limb.lower].rest.rotation);
        const glm::dvec3 axis = rest * (limit->frame * preferred_side(*limit));
        const glm::dvec3 side = glm::cross(axis, rest * limb.lower_bone);
        const glm::dvec3 across = side - limb.upper_bone * glm::dot(side, limb.upper_bone);
        constexpr double kClear = 0.2;  // radians
        if (glm::length(across) > kClear) limb.lower_side = glm::normalize(across);
    }

    static glm::dvec3 direction(const glm::dvec3& way) {
        const double length = glm::length(way);
        return length > 0.0 ? way / length : glm::dvec3(0.0);
    }

    void make_hand(FootPlan& hand, std::uint32_t source) const {
        hand.turn = turn_of_[source];
        hand.rest = glm::conjugate(source_.turn(source));
        hand.heel.source = source;
    }

    void make_foot(FootPlan& foot, const Limb& from, const Limb& to) const {
        make_hand(foot, from.foot_joint());
        foot.heel = make_contact(from.foot_joint(), to.foot_joint());
        if (from.toes() == kNone || to.toes() == kNone) return;
        foot.toes = make_contact(from.toes(), to.toes());
        foot.toes_carrier = to.joints[to.joints.size() - 2];
        foot.toes_at = place_in(foot.toes_carrier, to.toes());
    }

    [[nodiscard]] ContactPlan make_contact(std::uint32_t source, std::uint32_t target) const {
        const double from = glm::dot(plan_.source_up, source_.place(source) - plan_.map.from) + source_.raised();
        const double to = glm::dot(plan_.up, target_.place(target) - plan_.map.to) + target_.raised();
        return {source, from, to - plan_.map.scale * from};
    }

    /// Finds what touches what. Props count that both hold in a hand.
    void find_surfaces() {
        std::vector<std::uint32_t> from, to, hands;
        for (const MovedJoint& moved : plan_.moved) {
            const std::uint32_t hand = moved.is_prop && to.size() < kMostProps ? hand_above(moved.joint) : kNone;
            if (hand == kNone) continue;
            from.push_back(moved.source);
            to.push_back(moved.joint);
            hands.push_back(hand);
        }
        plan_.source_surface = find_surface(source_, from);
        plan_.surface = find_surface(target_, to);
        for (std::size_t k = 0; k < hands.size(); ++k) plan_.surface.shells.at(kBodyShells + k).held_by = hands[k];
    }

    /// Returns the hand that a joint of the target is below, 0 or 1; kNone if there is none.
    [[nodiscard]] std::uint32_t hand_above(std::uint32_t joint) const {
        for (std::uint32_t hand = 0; hand < plan_.hands.size(); ++hand) {
            const LimbPlan& arm = plan_.limbs.at(plan_.feet.size() + hand);
            if (arm.foot != kNone && links_between(arm.foot, joint) != 0) return hand;
        }
        return kNone;
    }

    void match_morph_targets() {
        plan_.morph_targets.assign(plan_.target.morph_target_count(), kNone);
        const Binding names(plan_.source, plan_.target);
        for (std::uint32_t from = 0; from < names.targets().size(); ++from) {
            const std::uint32_t to = names.targets()[from];
            if (to != kNone && plan_.morph_targets[to] == kNone) plan_.morph_targets[to] = from;
        }
        match_spellings();
    }

    /// The others follow the first one there whose name is the same but for its spelling.
    void match_spellings() {
        std::map<std::string, std::uint32_t> by_key;
        std::uint32_t number = 0;
        for (const Mesh& mesh : plan_.source.meshes()) {
            for (const MorphTargetView& target : mesh.targets) by_key.try_emplace(target_key(target.name), number++);
        }
        by_key.erase("");
        number = 0;
        for (const Mesh& mesh : plan_.target.meshes()) {
            for (const MorphTargetView& target : mesh.targets) {
                std::uint32_t& from = plan_.morph_targets[number++];
                if (from != kNone) continue;
                const auto found = by_key.find(target_key(target.name));
                if (found != by_key.end()) from = found->second;
            }
        }
    }

    RetargetPlan& plan_;
    const Body& source_;
    const Body& target_;
    std::vector<JointPair> pairs_;
    std::vector<std::uint32_t> turn_of_;   // of each joint of the source
    std::vector<std::uint32_t> moved_of_;  // of each joint of the target
};

/// Returns what is wrong with a body, if anything is.
std::optional<RetargetError> fault_of(Body& body, bool is_source) {
    if (body.model().roles().empty()) return RetargetError{RetargetError::Reason::no_roles, is_source};
    if (!body.measure()) return RetargetError{RetargetError::Reason::not_finite, is_source};
    return std::nullopt;
}

const StandingPoseRecord* record_of(const Model& model) {
    return model.standing_pose() == nullptr ? nullptr : &model.standing_pose()->pose;
}

Body body_of(const Model& model, const RetargetOptions& options) {
    if (options.rest_poses == RestPoses::measured) return {model, standing_locals(model), record_of(model)};
    std::vector<JointTransform> rest;
    for (const Joint& joint : model.joints()) rest.push_back(joint.rest);
    return {model, rest, nullptr};
}

}  // namespace

Result<Retarget, RetargetError> RetargetPlan::make(const Model& source, const Model& target,
                                                   const RetargetOptions& options) {
    Body from = body_of(source, options), to = body_of(target, options);
    if (options.rest_poses == RestPoses::measured) {
        const std::vector<JointTransform> locals = locals_of_same_rig(source, target);
        if (!locals.empty()) from = Body(source, locals, record_of(target));
    }
    if (auto fault = fault_of(from, true)) return *fault;
    if (auto fault = fault_of(to, false)) return *fault;
    if (from.kind() != to.kind()) return RetargetError{RetargetError::Reason::other_body, true, from.kind(), to.kind()};
    auto plan = std::make_unique<RetargetPlan>(source, target);
    plan->options = options;
    PlanMaker(*plan, from, to).make();
    return Retarget(std::move(plan));
}

Result<Retarget, RetargetError> Retarget::make(const Model& source, const Model& target,
                                               const RetargetOptions& options) {
    return RetargetPlan::make(source, target, options);
}

std::string error_text(const RetargetError& error) {
    if (error.reason == RetargetError::Reason::other_body) {
        constexpr std::array kKinds{"a human", "an animal on four legs", "an animal on two legs"};
        return std::string("the source is ") + kKinds[static_cast<std::size_t>(error.source)] + " and the target " +
               kKinds[static_cast<std::size_t>(error.target)] + ": nothing is retargeted between them";
    }
    const std::string who = error.is_source ? "the source" : "the target";
    if (error.reason == RetargetError::Reason::no_roles)
        return who + " does not say what its joints are: list them as \"roles\" in its rig file";
    return who + " has joints at places that are not finite";
}

}  // namespace bendy
