#include "ik_quick.h"

#include "ik_problem.h"
#include "math/nearest_rotation.h"
#include "pose/pose_state.h"

#include <bendy/format/public.h>
#include <bendy/format/trig.h>

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>

namespace bendy {
namespace {

BENDY_ALWAYS_INLINE double squared(const glm::dvec3& v) {
    return v.x * v.x + v.y * v.y + v.z * v.z;
}

BENDY_ALWAYS_INLINE double squared(const glm::dquat& q) {
    return q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
}

BENDY_ALWAYS_INLINE glm::dvec3 vector_of(const glm::dquat& q) {
    return {q.x, q.y, q.z};
}

/// Rotates a vector by a unit quaternion.
BENDY_ALWAYS_INLINE glm::dvec3 turned(const glm::dquat& q, const glm::dvec3& v) {
    const glm::dvec3 u = vector_of(q);
    const glm::dvec3 across = glm::cross(u, v) * 2.0;
    return v + across * q.w + glm::cross(u, across);
}

/// Returns the rotation with these unit x, y and z axes, with the sign nearest to `like`.
BENDY_ALWAYS_INLINE glm::dquat rotation_of(const glm::dvec3& x, const glm::dvec3& y, const glm::dvec3& z,
                                           const glm::dquat& like) {
    const glm::dquat q = glm::quat_cast(glm::dmat3(x, y, z));
    return q.w * like.w + q.x * like.x + q.y * like.y + q.z * like.z < 0.0 ? -q : q;
}

/// Computes the unit normal of the plane through two directions; returns false if they are (nearly) parallel.
BENDY_ALWAYS_INLINE bool find_normal(const glm::dvec3& a, const glm::dvec3& b, glm::dvec3& normal) {
    constexpr double kClear = 1e-12;
    normal = glm::cross(a, b);
    const double size = squared(normal);
    if (!(size > kClear * squared(a) * squared(b))) return false;
    normal *= 1.0 / std::sqrt(size);
    return true;
}

/// Normalises a quaternion. Returns false for a zero quaternion and for NaN.
BENDY_ALWAYS_INLINE bool normalize(glm::dquat& q) {
    const double length = squared(q);
    constexpr double kLeast = 1e-200, kMost = 1e200;
    if (!(length > kLeast && length < kMost)) return false;
    q = q * (1.0 / std::sqrt(length));
    return true;
}

/// Reads a joint's rotation and normalises it; returns false if its length is off by more than rounding.
BENDY_ALWAYS_INLINE bool read_rotation(const JointTransform& joint, glm::dquat& rotation) {
    const glm::dquat q(joint.rotation);
    const double off = squared(q) - 1.0;
    constexpr double kMost = 1e-5;
    rotation = q * (1.0 - 0.5 * off);
    return std::abs(off) < kMost;
}

/// Whether all axes have one scale, to within `same` of it, and there is no shear.
BENDY_ALWAYS_INLINE bool is_even(const JointTransform& transform, const Joint& joint, float same) {
    const glm::vec3& s = transform.scale;
    return s.x > 0.0f && std::abs(s.x - s.y) <= same * s.x && std::abs(s.x - s.z) <= same * s.x &&
           joint.shear == glm::vec3(0.0f);
}

/// The mean of the axes' scales.
BENDY_ALWAYS_INLINE double mean_scale(const JointTransform& transform) {
    const glm::dvec3 scale(transform.scale);
    return (scale.x + scale.y + scale.z) / 3.0;
}

/// A vector at right angles to a unit axis, turned about it.
BENDY_ALWAYS_INLINE glm::dvec3 rolled(const glm::dvec3& v, const glm::dvec3& axis, double angle) {
    const trig::SinCos turn = trig::sin_cos(angle);
    return v * turn.cos + glm::cross(axis, v) * turn.sin;
}

/// Converts a point from model space to base space; not finite if the base is flat.
BENDY_ALWAYS_INLINE glm::dvec3 from_model(const glm::dmat4& base, const glm::dvec3& point) {
    const glm::dvec3 x(base[0]), y(base[1]), z(base[2]);
    const glm::dvec3 way = point - glm::dvec3(base[3]);
    const glm::dvec3 across = glm::cross(y, z);
    const double volume = 1.0 / glm::dot(x, across);
    return glm::dvec3(glm::dot(way, across), glm::dot(way, glm::cross(z, x)), glm::dot(way, glm::cross(x, y))) * volume;
}

/// A joint's constraint while its chain is solved.
class LinkConstraint {
public:
    BENDY_ALWAYS_INLINE LinkConstraint(const Model& model, std::uint32_t joint, const ReachOptions& options)
        : constraint_(options.obey_constraints ? model.ik_constraint(joint) : nullptr),
          rest_(&model.joints()[joint].rest) {}

    BENDY_ALWAYS_INLINE bool is_there() const { return constraint_ != nullptr; }
    BENDY_ALWAYS_INLINE bool is_hinge() const { return is_there() && constraint_->model == ConstraintModel::hinge; }
    [[nodiscard]] bool prefers_back() const { return bendy::prefers_back(constraint_); }
    /// True if it only restricts which rotations are legal.
    BENDY_ALWAYS_INLINE bool is_plain() const { return !is_there() || says_rotations_only(); }
    /// Computes the only axis about which the joint bends, in the parent's space, for a unit rotation; returns false if
    /// there are others.
    BENDY_ALWAYS_INLINE bool find_bend_axis(const glm::dquat& local, glm::dvec3& axis) const {
        const glm::dvec3 only = is_there() ? only_axis(*constraint_) : glm::dvec3(0.0);
        if (only == glm::dvec3(0.0)) return false;
        const glm::dquat before = is_hinge() ? local : glm::normalize(glm::dquat(rest_->rotation));
        axis = turned(before, turned(constraint_->frame, only));
        return true;
    }

    /// Computes the axis of the wider swing in the parent's space; returns false if there are not two swings.
    [[nodiscard]] bool find_wider_axis(glm::dvec3& axis) const {
        const glm::dvec3 wider = is_there() ? wider_axis(*constraint_) : glm::dvec3(0.0);
        axis = turned(glm::normalize(glm::dquat(rest_->rotation)), turned(constraint_->frame, wider));
        return wider != glm::dvec3(0.0);
    }

    enum class Side : std::uint8_t { inside, edge, outside };
    /// Returns on which side of the limits a unit rotation is; the edge is what rounding could put on either side.
    BENDY_ALWAYS_INLINE Side side(const glm::dquat& local) const {
        return is_there() ? find_side(local) : Side::inside;
    }
    BENDY_ALWAYS_INLINE bool holds(const glm::dquat& local) const { return side(local) == Side::inside; }

private:
    [[nodiscard]] bool says_rotations_only() const {
        return constraint_->model != ConstraintModel::locked && !constraint_->has_soft_zone &&
               constraint_->stiffness == glm::dvec3(0.0);
    }
    [[nodiscard]] Side find_side(const glm::dquat& local) const {
        const glm::dquat& frame = constraint_->frame;
        const glm::dquat rest = glm::normalize(glm::dquat(rest_->rotation));
        const glm::dquat R = glm::conjugate(rest * frame) * local * frame;
        const glm::dquat legal =
            quick_legal_rotation(constraint_->model, constraint_->euler_order, constraint_->shape, R);
        const double off = 4.0 * squared(vector_of(glm::conjugate(legal) * R));  // angle squared
        constexpr double kInside = 1e-7, kOutside = 2e-6;
        if (off < kInside * kInside) return Side::inside;
        return off > kOutside * kOutside ? Side::outside : Side::edge;
    }

    const Constraint* constraint_;
    const JointTransform* rest_;
};

/// Finds the pole as seen from the chain's start, in base space; returns false if it has none.
BENDY_ALWAYS_INLINE bool find_pole(const Chain& chain, PoseState& state, const ReachOptions& options,
                                   const glm::dmat4& base, const glm::dvec3& origin, glm::dvec3& pole) {
    const auto& vector = chain.record.pole_vector;
    pole = {vector[0], vector[1], vector[2]};
    if (options.pole) {
        pole = from_model(base, *options.pole) - origin;
    } else if (chain.pole != kNone) {
        pole = from_model(base, glm::dvec3(state.fresh_matrix(chain.pole)[3])) - origin;
    } else {
        return pole != glm::dvec3(0.0);
    }
    return true;
}

/// In units of base space, like `length`.
BENDY_ALWAYS_INLINE double tolerance_of(const Chain& chain, const ReachOptions& options, const glm::dmat4& base,
                                        double length) {
    const float tolerance = options.tolerance > 0.0f ? options.tolerance : chain.record.tolerance;
    constexpr double kOfLength = 1e-4, kLeast = 1e-9;
    if (!(tolerance > 0.0f)) return kOfLength * length;
    const double scale =
        std::max({squared(glm::dvec3(base[0])), squared(glm::dvec3(base[1])), squared(glm::dvec3(base[2]))});
    return std::max(double{tolerance} / std::sqrt(scale), kLeast * length);
}

/// Returns the length of a base-space vector in model space, in metres.
BENDY_ALWAYS_INLINE float length_in_model(const glm::dmat4& base, const glm::dvec3& v) {
    return static_cast<float>(std::sqrt(squared(glm::dmat3(base) * v)));
}

/// How the middle joint bends: the rest of the chain rotates about a unit axis, relative to the start.
struct Bend {
    bool is_fixed;      ///< the joint bends about no other axis
    glm::dvec3 bone;    ///< start to middle
    glm::dvec3 axis;    ///< of the rotation
    glm::dvec3 across;  ///< middle to tip: the part that rotates
    glm::dvec3 along;   ///< middle to tip: the part along the axis
    double b, c;        ///< component of the rotated `across` along the bone, at an angle: b cos + c sin
    double wanted;      ///< the value which that must have
    double most;        ///< b^2 + c^2
    double opening;     ///< sqrt(most - wanted^2): the opening to either side of the straight chain
};

struct Turn {
    double cosine, sine;
};

/// Returns the rotation to one side, -1 or 1.
BENDY_ALWAYS_INLINE Turn turn_to(const Bend& bend, double side) {
    const double share = 1.0 / bend.most;
    return {(bend.b * bend.wanted + side * bend.c * bend.opening) * share,
            (bend.c * bend.wanted - side * bend.b * bend.opening) * share};
}

/// Completes a bend whose `bone`, `is_fixed` and, if it is fixed, `axis` are set. Returns false if the chain is
/// straight or cannot have the length `distance` (squared).
BENDY_ALWAYS_INLINE bool find_bend(const glm::dvec3& rest, double distance, Bend& bend) {
    const double sizes = squared(bend.bone) * squared(rest);
    constexpr double kStraight = 1e-8;
    double along = 0.0;
    bend.across = rest;
    bend.along = glm::dvec3(0.0);
    if (bend.is_fixed) {
        bend.along = bend.axis * glm::dot(rest, bend.axis);
        bend.across = rest - bend.along;
        along = glm::dot(bend.bone, bend.along);
        bend.b = glm::dot(bend.bone, bend.across);
        bend.c = glm::dot(bend.bone, glm::cross(bend.axis, bend.across));
        bend.most = bend.b * bend.b + bend.c * bend.c;
    } else {
        const glm::dvec3 normal = glm::cross(bend.bone, rest);
        const double size = squared(normal);
        if (!(size > kStraight * sizes)) return false;
        bend.c = -std::sqrt(size);
        bend.axis = normal * (-1.0 / bend.c);
        bend.b = glm::dot(bend.bone, rest);
        bend.most = sizes;
    }
    bend.wanted = 0.5 * (distance - squared(bend.bone) - squared(rest)) - along;
    const double left = bend.most - bend.wanted * bend.wanted;
    if (!(bend.most > kStraight * sizes && left > kStraight * bend.most)) return false;
    bend.opening = std::sqrt(left);
    return true;
}

/// Computes the middle joint's rotation after the turn; returns false if the turn is half a revolution.
BENDY_ALWAYS_INLINE bool turn_middle(const Bend& bend, const Turn& turn, const glm::dquat& before, glm::dquat& after) {
    after = glm::dquat(1.0 + turn.cosine, bend.axis * turn.sine) * before;
    constexpr double kHalfAround = 1e-9;
    return 1.0 + turn.cosine > kHalfAround && normalize(after);
}

/// Bends by the smaller rotation, or by the other one about a fixed axis, and returns on which side of the limits that
/// is; the edge if no rotation is clear.
BENDY_ALWAYS_INLINE LinkConstraint::Side bend_middle(const LinkConstraint& limit, const Bend& bend,
                                                     const glm::dquat& before, glm::dquat& local, Turn& turn) {
    using Side = LinkConstraint::Side;
    turn = turn_to(bend, -1.0);
    if (!limit.is_there()) return turn_middle(bend, turn, before, local) ? Side::inside : Side::edge;
    Turn other = turn;
    if (bend.is_fixed) other = turn_to(bend, 1.0);
    constexpr double kSame = 1e-6;
    const double gain = other.cosine - turn.cosine;
    if (std::abs(gain) > kSame ? gain > 0.0 : limit.prefers_back()) std::swap(turn, other);
    if (!turn_middle(bend, turn, before, local)) return Side::edge;
    const Side side = limit.side(local);
    if (side != Side::outside || !bend.is_fixed) return side;
    turn = other;
    return turn_middle(bend, turn, before, local) ? limit.side(local) : Side::edge;
}

/// Rotates the start by the smallest rotation that brings the tip, at `reached` relative to the start, into the
/// direction of the target.
BENDY_ALWAYS_INLINE bool aim_start(const glm::dvec3& reached, const glm::dvec3& way, double distance,
                                   glm::dquat& rotation) {
    const glm::dvec3 from = turned(rotation, reached);  // has the length of `way`
    const glm::dquat turn(distance + glm::dot(from, way), glm::cross(from, way));
    rotation = turn * rotation;
    constexpr double kOpposite = 1e-9;
    return turn.w > kOpposite * distance && normalize(rotation);
}

std::optional<ReachResult> reach_two_bone(const Chain& chain, const ReachTarget& target, Pose& pose,
                                          const ReachOptions& options) {
    const Model& model = pose.model();
    const auto joints = model.joints();
    PoseState& state = PoseState::of(pose);
    const std::uint32_t tip = chain.effector;
    const std::uint32_t middle = joints[tip].parent;
    const std::uint32_t start = chain.start;
    const JointTransform start_local = state.local_of(start);
    const JointTransform middle_local = state.local_of(middle);
    const JointTransform tip_local = state.local_of(tip);
    glm::dquat upper, lower, end;
    const float same = same_scale(chain, options);
    const bool is_plain = is_even(start_local, joints[start], same) && is_even(middle_local, joints[middle], same) &&
                          read_rotation(start_local, upper) && read_rotation(middle_local, lower) &&
                          read_rotation(tip_local, end);
    if (!is_plain) return std::nullopt;
    const LinkConstraint upper_limit(model, start, options);
    const LinkConstraint lower_limit(model, middle, options);
    const LinkConstraint end_limit(model, tip, options);
    const bool is_legal = upper_limit.is_plain() && lower_limit.is_plain() && end_limit.is_plain() &&
                          !upper_limit.is_hinge() && upper_limit.holds(upper) && lower_limit.holds(lower) &&
                          end_limit.holds(end);
    if (!is_legal) return std::nullopt;

    const glm::dmat4 base = state.fresh_matrix(joints[start].parent);
    const glm::dvec3 origin(start_local.translation);
    const glm::dvec3 way = from_model(base, target.position) - origin;
    const double distance = squared(way);
    Bend bend;
    bend.bone = glm::dvec3(start_local.scale) * glm::dvec3(middle_local.translation);
    const glm::dvec3 rest =
        turned(lower, mean_scale(start_local) * glm::dvec3(middle_local.scale) * glm::dvec3(tip_local.translation));
    bend.is_fixed = lower_limit.find_bend_axis(lower, bend.axis);
    const glm::dquat before = lower;
    const auto bend_there = [&](Turn& turn) {
        return find_bend(rest, distance, bend) ? bend_middle(lower_limit, bend, before, lower, turn)
                                               : LinkConstraint::Side::edge;
    };
    Turn turn{};
    LinkConstraint::Side side = bend_there(turn);
    if (side == LinkConstraint::Side::outside && lower_limit.find_wider_axis(bend.axis)) {
        bend.is_fixed = true;
        side = bend_there(turn);
    }
    if (side != LinkConstraint::Side::inside) return std::nullopt;
    const glm::dvec3 reached =
        bend.bone + bend.along + bend.across * turn.cosine + glm::cross(bend.axis, bend.across) * turn.sine;

    glm::dvec3 pole;
    if (!find_pole(chain, state, options, base, origin, pole)) {
        if (!aim_start(reached, way, distance, upper)) return std::nullopt;
    } else {
        // From the tip's direction and the knee's side to the target's direction and the pole's side.
        glm::dvec3 from_z = -bend.axis, to_z;
        if (!find_normal(way, pole, to_z) || (bend.is_fixed && !find_normal(reached, bend.bone, from_z)))
            return std::nullopt;
        const double unit = 1.0 / std::sqrt(distance);
        const glm::dvec3 from_x = reached * unit, to_x = way * unit;
        if (chain.record.pole_angle != 0.0f) to_z = rolled(to_z, to_x, chain.record.pole_angle);
        const glm::dvec3 from_y = glm::cross(from_z, from_x), to_y = glm::cross(to_z, to_x);
        upper = rotation_of(to_x * from_x.x + to_y * from_y.x + to_z * from_z.x,
                            to_x * from_x.y + to_y * from_y.y + to_z * from_z.y,
                            to_x * from_x.z + to_y * from_y.z + to_z * from_z.z, upper);
    }
    if (!upper_limit.holds(upper)) return std::nullopt;

    const double length = std::sqrt(squared(bend.bone)) + std::sqrt(squared(rest));
    const double left = std::abs(std::sqrt(squared(reached)) - std::sqrt(distance));  // the direction is already right
    if (!(left <= tolerance_of(chain, options, base, length)) || !(squared(upper) > 0.5)) return std::nullopt;
    state.set_rotation(start, glm::quat(upper));
    state.set_rotation(middle, glm::quat(lower));
    return ReachResult{ReachStatus::reached, length_in_model(base, way * (left / std::sqrt(distance))), 0.0f, 1};
}

std::optional<ReachResult> reach_aim(const Chain& chain, const ReachTarget& target, Pose& pose,
                                     const ReachOptions& options) {
    const Model& model = pose.model();
    const std::uint32_t joint = chain.start;
    PoseState& state = PoseState::of(pose);
    const JointTransform transform = state.local_of(joint);
    const LinkConstraint limit(model, joint, options);
    const auto& turned_tip = chain.record.tip_rotation;
    glm::dquat rotation;
    glm::dquat tip(turned_tip[3], turned_tip[0], turned_tip[1], turned_tip[2]);
    constexpr double kOdd = 1e4;  // of a squared length: invalid rotations are left to the general solver
    const bool is_plain = read_rotation(transform, rotation) && limit.is_plain() && !limit.is_hinge() &&
                          limit.holds(rotation) && squared(tip) < kOdd && kOdd * squared(tip) > 1.0 && normalize(tip);
    if (!is_plain) return std::nullopt;
    const glm::dmat4 base = state.fresh_matrix(model.joints()[joint].parent);
    const glm::dvec3 origin(transform.translation);
    const glm::dvec3 way = from_model(base, target.position) - origin;
    const double distance = std::sqrt(squared(way));
    const glm::dvec3 ahead = way * (1.0 / distance);
    const glm::dvec3 forward = turned(rotation, turned(tip, {0.0, 0.0, 1.0}));
    const glm::dquat turn(1.0 + glm::dot(forward, ahead), glm::cross(forward, ahead));
    const double tolerance = tolerance_of(chain, options, base, 1.0);
    // If it already looks at the target, nothing changes; directly behind, the shortest rotation is not unique.
    constexpr double kOpposite = 1e-4;
    if (!(squared(vector_of(turn)) > 4.0 * tolerance * tolerance && turn.w > kOpposite)) return std::nullopt;
    glm::dvec3 pole;
    if (!find_pole(chain, state, options, base, origin, pole)) {
        rotation = turn * rotation;
        if (!normalize(rotation)) return std::nullopt;
    } else {
        glm::dvec3 aside;
        // Limits may stop the turn before the roll makes it legal.
        if (limit.is_there() || !find_normal(pole, way, aside)) return std::nullopt;
        if (chain.record.pole_angle != 0.0f) aside = rolled(aside, ahead, chain.record.pole_angle);
        const glm::dquat look = rotation_of(aside, glm::cross(ahead, aside), ahead, rotation * tip);
        rotation = look * glm::conjugate(tip);
    }
    if (!limit.holds(rotation) || !(squared(rotation) > 0.5)) return std::nullopt;
    state.set_rotation(joint, glm::quat(rotation));
    return ReachResult{ReachStatus::aimed, length_in_model(base, way), 0.0f, 1};
}

}  // namespace

std::optional<ReachResult> reach_quickly(const Chain& chain, const ReachTarget& target, Pose& pose,
                                         const ReachOptions& options) {
    constexpr std::uint32_t kTwoBones = 3;  // links, including the effector
    const Solver solver = options.solver != Solver::any ? options.solver : chain.solver;
    const bool is_aim = solver == Solver::aim && chain.links == 1;
    const bool is_two_bone = (solver == Solver::any || solver == Solver::two_bone) && chain.links == kTwoBones;
    const ChainRecord& record = chain.record;
    const bool is_plain = options.influence == 1.0f && options.softness == 0.0f && !target.rotation &&
                          !(record.stretch > 0.0f) && !(record.compress > 0.0f) && std::isfinite(record.pole_angle) &&
                          record.tip_offset == std::array{0.0f, 0.0f, 0.0f};
    if (!is_plain || !(is_aim || is_two_bone) || !pose.model().chain_weights(chain).empty()) return std::nullopt;
    return is_aim ? reach_aim(chain, target, pose, options) : reach_two_bone(chain, target, pose, options);
}

}  // namespace bendy
