#pragma once

#include <bendy/format/public.h>
#include <bendy/runtime/ik.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "math/rotation.h"
#include "pose/pose_state.h"

#include <span>

// A chain as the solvers see it: in the space of the start's parent ("base space"), with lengths in chain lengths.
namespace bendy {

struct IkProblem {
    std::span<IkLink> links;
    glm::dvec3 origin{0};       ///< of the first link
    double scale = 1.0;         ///< metres per chain length
    glm::dvec3 target{0};       ///< wanted position of the tip
    bool has_rotation = false;  ///< whether target_rotation counts
    bool stays_close = false;   ///< to where the links are rather than to where they were saved
    double position_weight = 1.0;
    double rotation_weight = 0.0;
    glm::dquat target_rotation{1, 0, 0, 0};
    glm::dquat tip_rotation{1, 0, 0, 0};  ///< relative to the last link
    bool has_pole = false;
    glm::dvec3 pole{0};            ///< point to bend towards
    double pole_angle = 0.0;       ///< radians from the pole to the bend
    double reach = 1.0;            ///< total length of the bones: 1, or 0 for a chain without length
    double longest = 0.0;          ///< an upper bound of that in a chain with uneven scales
    bool is_out_of_reach = false;  ///< the target is farther from the origin than that
    double tolerance = 1e-4;       ///< chain lengths; radians
    std::uint32_t iterations = 0;  ///< maximum; 0: the solver's default
    const ReachOptions* options = nullptr;
    bool is_uneven =
        false;  ///< a link before the last scales its axes unevenly, so that bones change length as it turns

    glm::dvec3 tip{0};                  ///< computed by place
    glm::dquat tip_global{1, 0, 0, 0};  ///< computed by place

    /// Computes positions and orientations from the links' rotations, from link `first` on.
    void place(std::size_t first = 0);
    /// The same for only the link after `link`, or the tip if `link` is the last.
    void place_next(std::size_t link);
    [[nodiscard]] glm::dquat parent_global(std::size_t link) const;
    [[nodiscard]] double distance() const;        ///< tip to target, chain lengths
    [[nodiscard]] double rotation_error() const;  ///< radians; 0 if rotation does not count
    [[nodiscard]] bool is_reached() const;
    /// Returns true if the target is out of reach and the tip as near to it as a straight chain can be. Limits may hold
    /// a straight chain away from the target, where a bent one comes nearer.
    [[nodiscard]] bool is_stretched_out() const;
    /// The quantity that the solvers minimise: the weighted sum of both errors squared.
    [[nodiscard]] double cost() const;
    void save();

private:
    void place_unevenly();
};

/// Returns the rotation moved inside the link's constraint.
glm::dquat legal_local(const IkLink& link, const glm::dquat& local);
/// Returns the rotation that a link's limits prefer, or that in their middle; at rest if it has none.
glm::dquat middle_local(const IkLink& link);
/// As legal_local, but a step from link.local into the soft zone is halved.
glm::dquat softly_legal_local(const IkLink& link, const glm::dquat& local);
/// Returns a rotation vector in base space, scaled by the link's freedom about each of its axes.
glm::dvec3 freed(const IkLink& link, const glm::dvec3& vector);
/// Returns the solver that the options or else the chain asks for.
inline Solver solver_of(const Chain& chain, const ReachOptions& options) {
    return options.solver != Solver::any ? options.solver : chain.solver();
}
/// Returns the tolerance that the options or else the chain asks for, in metres; 0 if there is none.
inline float tolerance_of(const Chain& chain, const ReachOptions& options) {
    const float tolerance = options.tolerance > 0.0f ? options.tolerance : chain.record.tolerance;
    return tolerance > 0.0f ? tolerance : 0.0f;
}
/// Returns the share of its length over which a chain slows near full reach; 0 if it can stretch instead.
inline double softness_of(const Chain& chain, const ReachOptions& options) {
    const bool can_stretch = chain.record.stretch > 0.0f;
    return can_stretch ? 0.0 : clamped(options.softness, 0.0, 1.0, 0.0);
}
/// Returns how far the scales of a joint's axes may differ, as a share of them, and still count as one: what clips hold
/// after rounding, and what exporters leave. The bones below are then off by half of the default tolerance at most; if
/// a tolerance is given, by a millionth of their length.
inline float same_scale(const Chain& chain, const ReachOptions& options) {
    constexpr float kRounded = 5e-5f, kExact = 1e-6f;
    return tolerance_of(chain, options) > 0.0f ? kExact : kRounded;
}

/// The point or direction that a chain bends towards.
struct Pole {
    bool is_there = false, is_point = false;
    glm::dvec3 place{0.0};  ///< in model space if it is a point, otherwise a direction in base space
};
BENDY_ALWAYS_INLINE Pole find_pole(const Chain& chain, PoseState& state, const ReachOptions& options) {
    if (options.pole) return {true, true, *options.pole};
    if (chain.record.pole != kNone) return {true, true, glm::dvec3(state.fresh_matrix(chain.record.pole)[3])};
    const auto& vector = chain.record.pole_vector;
    const glm::dvec3 direction(vector[0], vector[1], vector[2]);
    return {direction != glm::dvec3(0.0), false, direction};
}

/// Returns the direction in which a joint prefers to turn or, if none is given, the side to which its constraint lets
/// it turn farther, as a rotation vector about the frame's axes: mirrored for a mirrored joint, whatever the
/// orientation of its axes. Zero if nothing is preferred.
glm::dvec3 preferred_side(const Constraint& constraint);
/// Returns the only axis, in the constraint's frame, about which the joint bends: that of a hinge, or of a swing of
/// zero width. Zero if there is none. It is an axis of the rest pose: a hinge does not turn its own, and a swing's is
/// the same whatever the twist.
glm::dvec3 only_axis(const Constraint& constraint);
/// Returns that axis in the parent's space, for a unit rotation of the joint: a hinge that is outside its constraint
/// bends about its axis as it is.
glm::dvec3 bend_axis(const Constraint& constraint, const glm::dquat& rest_frame, const glm::dquat& local);
/// Returns the axis of the swing that reaches farther, towards the preferred side. Zero if there is only one axis, or
/// no swing.
glm::dvec3 wider_axis(const Constraint& constraint);
/// Rotates a placed link in base space, as far as it is free and legal; returns the actual rotation. Does not place the
/// following links again.
glm::dquat turn_link(IkProblem& problem, std::size_t link, const glm::dquat& rotation);

// The solvers. Each starts with a placed problem whose links are legal, leaves it in that state, and returns its
// iterations.
std::uint32_t solve_pull(IkProblem& problem);
std::uint32_t solve_two_bone(IkProblem& problem);
/// Returns the smallest angle about a unit axis, to either side, so that a mirrored chain turns the other way, that
/// takes the start of a chain inside its constraint; 0 if none does. `rest_frame` is the constraint's frame at rest,
/// and `start` the start's rotation, aimed at the target; both in base space.
double best_swivel(const Constraint& constraint, const glm::dquat& rest_frame, const glm::dquat& start,
                   const glm::dvec3& axis);
/// Returns which of two equal rotations of a straight chain's joint with only_axis is preferred: true for the one
/// against the axis, whose sign in the file carries no meaning. False for other joints.
bool prefers_back(const Constraint* constraint);
std::uint32_t solve_aim(IkProblem& problem);
/// The same for a chain of at most kMostNewtonLinks: see ik_newton.cpp.
/// \param most      iterations
/// \param is_first  otherwise it begins with weaker springs
std::uint32_t solve_newton(IkProblem& problem, std::uint32_t most, bool is_first);
inline constexpr std::size_t kMostNewtonLinks = 10;
std::uint32_t solve_least_squares(IkProblem& problem, std::uint32_t most);
/// Solves from the pose at hand, or in closed form, and if that does not reach, from other starts: see ik_descend.cpp.
std::uint32_t solve_from(IkProblem& problem, bool is_closed);
/// Solves from where the links are, close to there, and does not try other starts.
std::uint32_t solve_again(IkProblem& problem);
/// Points every bone in turn at the target: for a chain that cannot reach it.
void point_at_target(IkProblem& problem);

}  // namespace bendy
