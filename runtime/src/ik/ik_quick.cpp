#include "ik_quick.h"

#include "ik_problem.h"
#include "math/nearest_rotation.h"
#include "one_limb.h"
#include "pose/pose_state.h"

#include <bendy/format/public.h>
#include <bendy/format/trig.h>

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>

namespace bendy {
namespace one_limb {
namespace {

/// A joint's constraint while its chain is solved.
class LinkConstraint {
public:
    BENDY_ALWAYS_INLINE LinkConstraint(const ModelData& model, std::uint32_t joint, const ReachOptions& options) {
        const std::uint32_t number = options.obey_constraints ? model.ik_constraint(joint) : kNone;
        if (number == kNone) return;
        constraint_ = &model.constraints[number];
        rest_frame_ = &model.rest_frames[number];
    }

    BENDY_ALWAYS_INLINE bool is_there() const { return constraint_ != nullptr; }
    BENDY_ALWAYS_INLINE bool is_hinge() const { return is_there() && constraint_->model() == ConstraintModel::hinge; }
    [[nodiscard]] bool prefers_back() const { return bendy::prefers_back(constraint_); }
    /// Returns true if it only restricts which rotations are legal.
    BENDY_ALWAYS_INLINE bool is_plain() const { return !is_there() || says_rotations_only(); }
    /// See bend_axis.
    [[nodiscard]] glm::dvec3 bend_axis(const glm::dquat& local) const {
        return is_there() ? bendy::bend_axis(*constraint_, *rest_frame_, local) : glm::dvec3(0.0);
    }
    /// Returns the axis of the wider swing in the parent's space; zero if there are not two swings.
    [[nodiscard]] glm::dvec3 wider_axis() const {
        return is_there() ? *rest_frame_ * bendy::wider_axis(*constraint_) : glm::dvec3(0.0);
    }

    /// Moves a unit rotation that is not inside the limits there; returns true if it was inside.
    BENDY_ALWAYS_INLINE bool make_legal(Rotation& local) const { return !is_there() || make_legal_within(local); }

    enum class Side : std::uint8_t { inside, edge, outside };
    /// Returns on which side of the limits a unit rotation is; "edge" if rounding could decide.
    BENDY_ALWAYS_INLINE Side side(const glm::dquat& local) const {
        return is_there() ? find_side(local) : Side::inside;
    }
    BENDY_ALWAYS_INLINE bool holds(const glm::dquat& local) const { return side(local) == Side::inside; }

private:
    [[nodiscard]] bool says_rotations_only() const {
        return constraint_->model() != ConstraintModel::locked && !constraint_->has_soft_zone &&
               constraint_->stiffness == glm::dvec3(0.0);
    }
    /// A rotation in the constraint's frame, and that inside the limits.
    struct Limited {
        Rotation from, to;
        double off;  ///< the angle between them, squared
    };
    static constexpr double kInside = 1e-7, kOutside = 2e-6;  // radians

    [[nodiscard]] Limited limited(const Rotation& local) const {
        const Rotation R = conjugate(rotation_of(*rest_frame_)) * local * rotation_of(constraint_->frame);
        const Rotation legal = rotation_of(quick_legal_rotation(*constraint_, constraint_->shape, glm_of(R)));
        const Rotation by = conjugate(legal) * R;
        return {R, legal, 4.0 * (by.x * by.x + by.y * by.y + by.z * by.z)};
    }
    [[nodiscard]] Side find_side(const glm::dquat& local) const {
        const double off = limited(rotation_of(local)).off;
        if (off < kInside * kInside) return Side::inside;
        return off > kOutside * kOutside ? Side::outside : Side::edge;
    }
    [[nodiscard]] bool make_legal_within(Rotation& local) const {
        const auto [from, to, off] = limited(local);
        if (off < kInside * kInside) return true;
        local = rotation_of(*rest_frame_) * to * conjugate(rotation_of(constraint_->frame));
        local = local * (1.0 / root(squared(local)));
        return false;
    }

    const Constraint* constraint_ = nullptr;
    const glm::dquat* rest_frame_ = nullptr;  // with a constraint
};

/// The limits of a limb's joints.
struct LimbLimits {
    BENDY_ALWAYS_INLINE LimbLimits(const ModelData& model, const Chain& chain, const ReachOptions& options)
        : upper(model, chain.record.start, options),
          lower(model, model.parents[chain.record.effector], options),
          end(model, chain.record.effector, options) {}

    BENDY_ALWAYS_INLINE bool are_there() const { return upper.is_there() || lower.is_there() || end.is_there(); }
    BENDY_ALWAYS_INLINE bool are_plain() const {
        return upper.is_plain() && lower.is_plain() && end.is_plain() && !upper.is_hinge();
    }

    LinkConstraint upper, lower, end;
};

/// Bends by the smaller rotation, or by the other one about a fixed axis, and returns on which side of the limits the
/// result is; "edge" if no rotation is clearly on one side.
BENDY_ALWAYS_INLINE LinkConstraint::Side bend_middle(const LinkConstraint& limit, const Limbs& limb, Bend& bend,
                                                     Turn& turn, Reaching& reach) {
    using Side = LinkConstraint::Side;
    const Rotation before = reach.lower;
    const bool is_fixed = load_flag(limb.is_fixed);
    Turn turns[2];
    if (!find_bend(reach, is_fixed, bend)) return Side::edge;
    find_turns(bend, is_fixed, load_flag(limb.prefers_back), turns);
    turn = turns[0];
    if (!turn_middle(bend, turn, before, reach.lower)) return Side::edge;
    const Side side = limit.side(glm_of(reach.lower));
    if (side != Side::outside) return side;
    if (!is_fixed) find_turns(bend, true, load_flag(limb.prefers_back), turns);
    turn = turns[1];
    if (!turn_middle(bend, turn, before, reach.lower)) return Side::edge;
    const Side other = limit.side(glm_of(reach.lower));
    return is_fixed || other == Side::outside ? other : Side::edge;  // the general solver turns the start half around
}

std::optional<ReachResult> reach_two_bone(const Chain& chain, const ReachTarget& target, Pose& pose,
                                          const ReachOptions& options) {
    PoseState& state = PoseState::of(pose);
    const ModelData& model = *state.data;
    Limbs limb;
    if (!gather_limb(chain, target, pose, options, limb, 0)) return std::nullopt;
    Reaching reach;
    Bend bend{};
    Turn turn;
    if (!begin(limb, reach, bend)) return std::nullopt;
    const LimbLimits limits(model, chain, options);
    const Rotation before = reach.lower;
    LinkConstraint::Side side = bend_middle(limits.lower, limb, bend, turn, reach);
    if (side == LinkConstraint::Side::outside) {
        const glm::dvec3 wider = limits.lower.wider_axis();
        if (wider == glm::dvec3(0.0)) return std::nullopt;
        bend.axis = vector_of(wider);
        limb.is_fixed[0][0] = 1.0;
        reach.lower = before;
        side = bend_middle(limits.lower, limb, bend, turn, reach);
    }
    if (side != LinkConstraint::Side::inside) return std::nullopt;
    const double distance = finish(limb, bend, turn, reach);
    if (!(distance >= 0.0)) return std::nullopt;
    const glm::dquat upper = glm_of(reach.upper);
    if (!limits.upper.holds(upper)) return std::nullopt;
    state.set_rotation(chain.record.start, glm::quat(upper));
    state.set_rotation(model.parents[chain.record.effector], glm::quat(glm_of(reach.lower)));
    if (limits.are_there()) make_end_legal(chain, pose, options);
    const ReachStatus status = is_out_of_reach(limb, bend, reach) ? ReachStatus::out_of_reach : ReachStatus::reached;
    return ReachResult{status, static_cast<float>(distance), 0.0f, 1};
}

std::optional<ReachResult> reach_aim(const Chain& chain, const ReachTarget& target, Pose& pose,
                                     const ReachOptions& options) {
    PoseState& state = PoseState::of(pose);
    const ModelData& model = *state.data;
    const std::uint32_t joint = chain.record.start;
    const JointTransform transform = state.local_of(joint);
    const LinkConstraint limit(model, joint, options);
    const auto& turned_tip = chain.record.tip_rotation;
    Rotation rotation = rotation_of(transform.rotation);
    Rotation tip{turned_tip[0], turned_tip[1], turned_tip[2], turned_tip[3]};
    constexpr double kOdd = 1e4;  // of a squared length: invalid rotations are left to the general solver
    const bool is_plain = normalize_local(rotation) && limit.is_plain() && !limit.is_hinge() && squared(tip) < kOdd &&
                          kOdd * squared(tip) > 1.0 && normalize(tip);
    if (!is_plain) return std::nullopt;
    limit.make_legal(rotation);
    const glm::dmat4 matrix = state.fresh_matrix(model.parents[joint]);
    const Space base{vector_of(matrix[0]), vector_of(matrix[1]), vector_of(matrix[2]), vector_of(matrix[3])};
    const Vector origin = vector_of(transform.translation);
    const Vector way = from_model(base, vector_of(target.position)) - origin;
    const double distance = std::sqrt(squared(way));
    const Vector ahead = way * (1.0 / distance);
    const Vector forward = turned(rotation, turned(tip, {0.0, 0.0, 1.0}));
    const Vector by = cross(forward, ahead);
    const Rotation turn{by.x, by.y, by.z, 1.0 + dot(forward, ahead)};
    const double tolerance = tolerance_in(base, tolerance_of(chain, options), 1.0);
    // If it already looks at the target, nothing changes; directly behind, the shortest rotation is not unique.
    constexpr double kOpposite = 1e-4;
    if (!(squared(by) > 4.0 * tolerance * tolerance && turn.w > kOpposite)) return std::nullopt;
    const Pole pole = find_pole(chain, state, options);
    if (!pole.is_there) {
        rotation = turn * rotation;
        if (!normalize(rotation)) return std::nullopt;
    } else {
        const Vector place = vector_of(pole.place);
        const Vector to_pole = pole.is_point ? from_model(base, place) - origin : place;
        Vector aside;
        // Limits may stop the turn before the roll makes it legal.
        if (limit.is_there() || !find_normal(to_pole, way, aside)) return std::nullopt;
        if (chain.record.pole_angle != 0.0f) {
            const trig::SinCos roll = trig::sin_cos(chain.record.pole_angle);
            aside = rolled(aside, ahead, roll.cos, roll.sin);
        }
        const Rotation look = rotation_of(aside, cross(ahead, aside), ahead, rotation * tip);
        rotation = look * conjugate(tip);
    }
    if (!limit.holds(glm_of(rotation)) || !(squared(rotation) > 0.5)) return std::nullopt;
    state.set_rotation(joint, glm::quat(glm_of(rotation)));
    return ReachResult{ReachStatus::aimed, static_cast<float>(root(squared(to_model(base, way)))), 0.0f, 1};
}

/// Returns true if only a position is requested, including the chain's own settings.
bool is_plain(const Chain& chain, const ReachTarget& target, const Pose& pose, const ReachOptions& options) {
    const ChainRecord& record = chain.record;
    return options.influence == 1.0f && !target.rotation && !(record.stretch > 0.0f) && !(record.compress > 0.0f) &&
           std::isfinite(record.pole_angle) && record.tip_offset == std::array{0.0f, 0.0f, 0.0f} &&
           pose.model().chain_weights(chain).empty();
}

bool is_two_bone(const Chain& chain, const ReachOptions& options) {
    constexpr std::uint32_t kLinks = 3;  // including the effector
    const Solver solver = solver_of(chain, options);
    return (solver == Solver::any || solver == Solver::two_bone) && chain.links == kLinks;
}

}  // namespace
}  // namespace one_limb

template <std::size_t count>
bool gather_limb(const Chain& chain, const ReachTarget& target, Pose& pose, const ReachOptions& options,
                 TwoBoneLimbs<count>& limbs, std::size_t number) {
    using namespace one_limb;
    PoseState& state = PoseState::of(pose);
    const ModelData& model = *state.data;
    const std::uint32_t start = chain.record.start;
    const std::uint32_t middle = model.parents[chain.record.effector];
    const LimbLimits limits(model, chain, options);
    const JointTransform tip = state.local_of(chain.record.effector);
    Rotation end = rotation_of(tip.rotation);
    if (model.joints[start].shear != glm::vec3(0.0f) || model.joints[middle].shear != glm::vec3(0.0f) ||
        !normalize_local(end) || !limits.are_plain()) {
        return false;
    }
    const JointTransform first = state.local_of(start);
    const JointTransform second = state.local_of(middle);
    const auto put_flag = [number](double(&to)[1][count], bool flag) { to[0][number] = flag ? 1.0 : 0.0; };
    bool is_fixed = false, prefers_back = false;
    glm::dvec3 axis(0.0);
    Rotation upper = rotation_of(first.rotation), lower = rotation_of(second.rotation);
    const Pole pole = find_pole(chain, state, options);
    if (limits.are_there()) {
        if (!normalize_local(upper) || !normalize_local(lower)) return false;
        if (!pole.is_there) limits.upper.make_legal(upper);  // with a pole, the result does not depend on it
        limits.lower.make_legal(lower);
        axis = limits.lower.bend_axis(glm_of(lower));
        is_fixed = axis != glm::dvec3(0.0);
        prefers_back = limits.lower.prefers_back();
    }
    put_flag(limbs.has_limits, limits.are_there());
    put_flag(limbs.is_fixed, is_fixed);
    put_flag(limbs.prefers_back, prefers_back);
    put(axis, limbs.axis, number);
    const glm::dmat4 base = state.fresh_matrix(model.parents[start]);
    put(base[0], limbs.base_x, number);
    put(base[1], limbs.base_y, number);
    put(base[2], limbs.base_z, number);
    put(base[3], limbs.base_origin, number);
    put(target.position, limbs.target, number);
    put(glm_of(upper), limbs.upper, number);
    put(glm_of(lower), limbs.lower, number);
    put(first.translation, limbs.origin, number);
    put(second.translation, limbs.middle, number);
    put(tip.translation, limbs.tip, number);
    put(first.scale, limbs.upper_scale, number);
    put(second.scale, limbs.lower_scale, number);
    limbs.same_scale[0][number] = same_scale(chain, options);
    limbs.tolerance[0][number] = tolerance_of(chain, options);
    limbs.softness[0][number] = softness_of(chain, options);
    put(pole.place, limbs.pole, number);
    put_flag(limbs.has_pole, pole.is_there);
    put_flag(limbs.is_pole_point, pole.is_point);
    const bool is_rolled = chain.record.pole_angle != 0.0f;
    const trig::SinCos roll = is_rolled ? trig::sin_cos(chain.record.pole_angle) : trig::SinCos{};
    put_flag(limbs.is_rolled, is_rolled);
    limbs.roll[0][number] = roll.cos;
    limbs.roll[1][number] = roll.sin;
    return true;
}

template bool gather_limb(const Chain&, const ReachTarget&, Pose&, const ReachOptions&,
                          TwoBoneLimbs<TwoBoneBlock::kLimbs>&, std::size_t);

bool are_legal(const Chain& chain, const Pose& pose, const ReachOptions& options, const glm::dquat& upper,
               const glm::dquat& lower) {
    const one_limb::LimbLimits limits(*PoseState::of(pose).data, chain, options);
    return limits.lower.holds(lower) && limits.upper.holds(upper);
}

void make_end_legal(const Chain& chain, Pose& pose, const ReachOptions& options) {
    PoseState& state = PoseState::of(pose);
    const std::uint32_t joint = chain.record.effector;
    one_limb::Rotation end = one_limb::rotation_of(state.local_of(joint).rotation);
    one_limb::normalize_local(end);
    if (!one_limb::LinkConstraint(*state.data, joint, options).make_legal(end))
        state.set_rotation(joint, glm::quat(one_limb::glm_of(end)));
}

bool is_plain_limb(const Chain& chain, const ReachTarget& target, const Pose& pose, const ReachOptions& options) {
    return one_limb::is_two_bone(chain, options) && one_limb::is_plain(chain, target, pose, options);
}

std::optional<ReachResult> reach_quickly(const Chain& chain, const ReachTarget& target, Pose& pose,
                                         const ReachOptions& options) {
    if (!one_limb::is_plain(chain, target, pose, options)) return std::nullopt;
    if (one_limb::is_two_bone(chain, options)) return one_limb::reach_two_bone(chain, target, pose, options);
    if (solver_of(chain, options) == Solver::aim && chain.links == 1)
        return one_limb::reach_aim(chain, target, pose, options);
    return std::nullopt;
}

}  // namespace bendy
