#pragma once

#include <bendy/runtime/ik.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include "pose/ik_link.h"

#include <span>

// A chain as the solvers see it: in the space of the start's parent, lengths in chain lengths.
namespace bendy {

struct IkProblem {
    std::span<IkLink> links;
    glm::dvec3 origin{0};       ///< of the first link
    double scale = 1.0;         ///< metres per chain length
    glm::dvec3 target{0};       ///< where the tip should be
    bool has_rotation = false;  ///< whether target_rotation counts
    double position_weight = 1.0;
    double rotation_weight = 0.0;
    glm::dquat target_rotation{1, 0, 0, 0};
    glm::dquat tip_rotation{1, 0, 0, 0};  ///< in the last link's axes
    bool has_pole = false;
    glm::dvec3 pole{0};            ///< point to bend towards
    double pole_angle = 0.0;       ///< radians from there to the bend
    double reach = 1.0;            ///< the bones' lengths together: 1, or 0 for a chain without length
    bool is_out_of_reach = false;  ///< the target is farther from the origin than that
    double tolerance = 1e-4;       ///< chain lengths; radians
    std::uint32_t iterations = 0;  ///< at most; 0: the solver's own
    const ReachOptions* options = nullptr;

    glm::dvec3 tip{0};                  ///< by place
    glm::dquat tip_global{1, 0, 0, 0};  ///< by place

    /// Positions and orientations from the links' rotations, from link `first` on.
    void place(std::size_t first = 0);
    /// The same of the one link after `link`, or of the tip if it is the last.
    void place_next(std::size_t link);
    [[nodiscard]] glm::dquat parent_global(std::size_t link) const;
    [[nodiscard]] double distance() const;        ///< tip to target, chain lengths
    [[nodiscard]] double rotation_error() const;  ///< radians; 0 if no rotation counts
    [[nodiscard]] bool is_reached() const;
    /// What the solvers make small: weighted squares of both errors.
    [[nodiscard]] double cost() const;
    void save();
    void restore();
};

/// The rotation brought inside the link's constraint.
glm::dquat legal_local(const IkLink& link, const glm::dquat& local);
/// The same by a slower and nearer way: for where a solver begins.
glm::dquat nearest_legal_local(const IkLink& link, const glm::dquat& local);
/// As legal_local, but a step from link.local into the soft zone goes half way only.
glm::dquat softly_legal_local(const IkLink& link, const glm::dquat& local);
/// A turn by a rotation vector in base space, lessened by the link's freedom about its axes.
glm::dvec3 freed(const IkLink& link, const glm::dvec3& vector);
/// Which way a joint prefers to turn, or where that is not said, to which side its constraint lets it turn farther, as
/// a rotation vector about the frame's axes: what a mirrored joint has mirrored, whichever way its axes are laid. Zero
/// where nothing is preferred.
glm::dvec3 preferred_side(const Constraint& constraint);
/// The axis, in the constraint's frame, about which alone the joint bends: a hinge's, or that of a swing which has no
/// width. Zero if there is none.
glm::dvec3 only_axis(const Constraint& constraint);
/// Turns a placed link by a rotation vector in base space as far as it is free and legal; returns what it turned by.
/// The links after it are not placed anew.
glm::dquat turn_link(IkProblem& problem, std::size_t link, const glm::dvec3& vector);
/// The same by a rotation, which is quicker where the link is wholly free.
glm::dquat turn_link(IkProblem& problem, std::size_t link, const glm::dquat& rotation);

// The solvers. Each begins with a placed problem whose links are legal, leaves it so, and returns its iterations.
std::uint32_t solve_pull(IkProblem& problem);
std::uint32_t solve_two_bone(IkProblem& problem);
/// Moves a two-bone problem's target nearer by its softness: near full reach, where a straight leg would snap, the tip
/// slows, comes nearer and nearer, and never arrives.
void soften_target(IkProblem& problem);
/// Of two equal turns of a straight chain's hinge, whether the one against its axis is preferred: which end of its axis
/// the file gives says nothing. False for what is no hinge.
bool hinge_prefers_back(const Constraint* constraint);
std::uint32_t solve_ccd(IkProblem& problem);
std::uint32_t solve_fabrik(IkProblem& problem);
std::uint32_t solve_aim(IkProblem& problem);
std::uint32_t solve_least_squares(IkProblem& problem);
/// Points every bone in turn at the target: what a chain does that cannot reach.
void point_at_target(IkProblem& problem);

}  // namespace bendy
