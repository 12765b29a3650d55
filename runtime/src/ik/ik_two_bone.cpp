#include "ik_problem.h"
#include "math/nearest_rotation.h"
#include "math/rotation.h"
#include "one_limb.h"

#include <bendy/format/trig.h>

#include <algorithm>
#include <cmath>

// Two bones in closed form: the middle joint turns until the tip is as far from the start as the target is; then the
// start turns the tip to the target, and rolls about the line between them until the bend points to the pole.
namespace bendy {
namespace {

constexpr double kSameTurn = 1e-6;  // radians, and cosines: within rounding of one another

/// Returns the link that bends: the one that divides the chain most evenly.
std::size_t find_middle(const IkProblem& problem) {
    std::size_t middle = 0;
    double best = 0.0;
    for (std::size_t i = 1; i < problem.links.size(); ++i) {
        const glm::dvec3& position = problem.links[i].position;
        const double shorter = std::min(glm::length(position - problem.origin), glm::length(problem.tip - position));
        if (problem.links[i].is_fixed || shorter <= best) continue;
        best = shorter;
        middle = i;
    }
    return middle;
}

/// Returns the axis about which the middle joint bends, not of unit length.
glm::dvec3 bend_axis(const IkProblem& problem, std::size_t link, const glm::dvec3& u, const glm::dvec3& v) {
    const IkLink& middle = problem.links[link];
    if (middle.constraint != nullptr) {
        const glm::dvec3 only = bend_axis(*middle.constraint, middle.rest_frame, middle.local);
        if (only != glm::dvec3(0.0)) return problem.parent_global(link) * only;
    }
    const double size = glm::length(u) * glm::length(v);
    glm::dvec3 axis = glm::cross(u, v);
    constexpr double kStraight = 1e-6;
    if (glm::length(axis) > kStraight * size) return axis;
    if (problem.has_pole) {
        axis = glm::cross(problem.pole - problem.origin, u);
        if (glm::length(axis) > kStraight * glm::length(u)) return axis;
    }
    // A straight chain bends in the direction that its joint prefers, otherwise about the more perpendicular of its
    // axes.
    const glm::dquat axes = middle.global * middle.frame;
    if (middle.constraint != nullptr) {
        axis = axes * preferred_side(*middle.constraint);
        axis -= u * (glm::dot(axis, u) / glm::dot(u, u));
        if (glm::length(axis) > kStraight) return axis;
    }
    const glm::dvec3 x = glm::cross(u, axes * glm::dvec3(1.0, 0.0, 0.0));
    const glm::dvec3 z = glm::cross(u, axes * glm::dvec3(0.0, 0.0, 1.0));
    return glm::dot(x, x) > glm::dot(z, z) ? glm::cross(x, u) : glm::cross(z, u);
}

/// Returns how far a rotation of the link would take it outside its constraint, in radians.
double illegality(const IkProblem& problem, std::size_t link, const glm::dquat& turn) {
    const IkLink& l = problem.links[link];
    if (l.constraint == nullptr) return 0.0;
    const glm::dquat local = glm::conjugate(problem.parent_global(link)) * turn * l.global;
    return excess(*l.constraint, l.constraint->shape, glm::conjugate(l.rest_frame) * local * l.frame);
}

struct MiddleTurn {
    glm::dquat turn{1.0, 0.0, 0.0, 0.0};
    double illegality = 0.0;  ///< radians
};

/// Returns the rotation of the middle joint about `axis` that brings the distance of the tip from the start as near as
/// possible to `distance`.
MiddleTurn find_middle_turn(const IkProblem& problem, std::size_t middle, const glm::dvec3& axis, double distance) {
    using namespace one_limb;
    const IkLink& link = problem.links[middle];
    const double size = glm::length(axis);
    if (size < 1e-12) return {};
    const Vector rest = vector_of(problem.tip - link.position);
    Bend bend{};
    bend.bone = vector_of(link.position - problem.origin);
    bend.axis = vector_of(axis / size);
    find_fixed_bend(rest, bend);
    find_opening(rest, distance * distance, bend);
    if (bend.most < 1e-24) return {};
    if (!(bend.opening > 0.0)) {  // straight, or folded
        bend.wanted = std::copysign(std::sqrt(bend.most), bend.wanted);
        bend.opening = 0.0;
    }
    Turn turns[2];
    find_turns(bend, true, prefers_back(link.constraint), turns);
    const auto found = [&](const Turn& turn) {
        Rotation q{0.0, 0.0, 0.0, 1.0};
        const bool is_clear = turn_middle(bend, turn, q, q);
        const glm::dquat by = is_clear ? glm_of(q) : glm::dquat(0.0, axis / size);
        return MiddleTurn{by, illegality(problem, middle, by)};
    };
    const MiddleTurn smaller = found(turns[0]);
    if (smaller.illegality <= kSameTurn) return smaller;
    const MiddleTurn other = found(turns[1]);
    return smaller.illegality - other.illegality > kSameTurn ? other : smaller;
}

/// Turns the middle joint so that the distance of the tip from the start is as near as possible to `distance`.
void bend(IkProblem& problem, std::size_t middle, double distance) {
    IkLink& link = problem.links[middle];
    const glm::dvec3 axis = bend_axis(problem, middle, link.position - problem.origin, problem.tip - link.position);
    MiddleTurn best = find_middle_turn(problem, middle, axis, distance);
    if (best.illegality > kSameTurn) {
        // The plane of the bones may be one in which the joint can hardly bend.
        const glm::dvec3 wider = problem.parent_global(middle) * (link.rest_frame * wider_axis(*link.constraint));
        const MiddleTurn legal = find_middle_turn(problem, middle, wider, distance);
        if (wider != glm::dvec3(0.0) && legal.illegality <= kSameTurn) best = legal;
    }
    if (best.illegality > kSameTurn) {
        // Starts from rest, in the direction in which the constraint allows most.
        const glm::dquat before = link.local;
        link.local = legal_local(link, glm::normalize(link.rest_frame * glm::conjugate(link.frame)));
        problem.place(middle);
        const glm::dvec3 preferred = link.global * (link.frame * preferred_side(*link.constraint));
        const MiddleTurn other = find_middle_turn(problem, middle, preferred, distance);
        if (other.illegality < best.illegality && preferred != glm::dvec3(0.0)) {
            best = other;
        } else {
            link.local = before;
            problem.place(middle);
        }
    }
    turn_link(problem, middle, best.turn);
    problem.place(middle);
}

/// Returns the rotation about `axis`, the line from start to target, that brings the bend, at `knee` from the start, to
/// the pole.
glm::dquat pole_turn(const IkProblem& problem, const glm::dvec3& knee, const glm::dvec3& axis) {
    const auto across = [&](const glm::dvec3& v) { return v - axis * glm::dot(axis, v); };
    const glm::dvec3 bend = across(knee);
    glm::dvec3 pole = across(problem.pole - problem.origin);
    if (glm::length(bend) < 1e-9 || glm::length(pole) < 1e-9) return {1.0, 0.0, 0.0, 0.0};
    if (problem.pole_angle != 0.0) pole = from_vector(axis * problem.pole_angle) * pole;
    const glm::dquat turn = between(bend, pole);
    return turn.w > 1e-6 ? turn : glm::dquat(0.0, axis);  // half a turn must be about this axis
}

}  // namespace

bool prefers_back(const Constraint* constraint) {
    return constraint != nullptr && glm::dot(only_axis(*constraint), preferred_side(*constraint)) < 0.0;
}

std::uint32_t solve_two_bone(IkProblem& problem) {
    const std::size_t middle = find_middle(problem);
    if (middle == 0) return 0;  // there are not two bones
    const glm::dvec3& knee = problem.links[middle].position;
    const double distance = glm::length(problem.target - problem.origin);
    bend(problem, middle, distance);
    const glm::dvec3 way = problem.target - problem.origin;
    glm::dquat aim = between(problem.tip - problem.origin, way);
    if (distance > 1e-12) {
        const glm::dvec3 axis = way / distance;
        if (problem.has_pole) aim = pole_turn(problem, aim * (knee - problem.origin), axis) * aim;
        if (problem.links[0].constraint != nullptr) {
            const IkLink& start = problem.links[0];
            const double angle = best_swivel(*start.constraint, start.rest_frame, aim * start.global, axis);
            if (angle != 0.0) aim = from_vector(axis * angle) * aim;
        }
    }
    turn_link(problem, 0, aim);
    problem.place();
    const std::size_t last = problem.links.size() - 1;
    if (problem.has_rotation && last > middle && problem.links[last].bone_length == 0.0) {
        turn_link(problem, last, problem.target_rotation * glm::conjugate(problem.tip_global));
        problem.place(last);
    }
    return 1;
}

}  // namespace bendy
