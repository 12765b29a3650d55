#pragma once

#include "math/rotation.h"
#include "pose/ik_link.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>

// The parts that the damped least-squares solvers share: see ik_least_squares.cpp.
namespace bendy {

/// Solves (A + damping) y = e in place, by Cholesky decomposition: `y` holds e first.
/// \param A     symmetric, with no negative eigenvalue, by rows of `stride` numbers; only its lower triangle is read,
/// and is overwritten \param size  rows, at most `stride`
void solve_damped(double* A, std::size_t stride, std::size_t size, double damping, double* y);

/// Returns a rotation vector in the space of the link's parent as what it costs: the less a joint is free about an
/// axis, the more.
inline glm::dvec3 strain_of(const IkLink& link, const glm::dvec3& turn) {
    const glm::dvec3& f = link.freedom;
    if (f == glm::dvec3(1.0)) return turn;
    constexpr double kLeast = 1e-3;
    return glm::conjugate(link.saved * link.frame) * turn / glm::max(f, glm::dvec3(kLeast));
}

/// A link's turn from where it started: the chord of its angle, which needs no trigonometry and grows up to half a
/// turn.
struct Spring {
    explicit Spring(const IkLink& link) {
        const glm::dquat by = upper_half(link.local * glm::conjugate(link.saved));
        turn = strain_of(link, 2.0 * glm::dvec3(by.x, by.y, by.z));
        bend = by.w;
    }
    [[nodiscard]] double square() const { return 2.0 * glm::dot(turn, turn) / (1.0 + bend); }

    glm::dvec3 turn;  ///< half the derivative of the square
    double bend;      ///< half the second one
};

struct Measured {
    double cost = 0.0, turns = 0.0;  ///< the latter: the sum of the springs' squares

    [[nodiscard]] double objective(double spring) const { return 0.5 * (cost + spring * turns); }
    /// Returns the weakest springs: the farther the target remains, the more the tip may miss it by for them.
    [[nodiscard]] double last_spring() const { return std::clamp(0.03 * cost, 1e-6, 1e-2); }
};

template <class Links>
Measured measured(const Links& links, double cost) {
    Measured now{cost};
    for (const IkLink& link : links) now.turns += Spring(link).square();
    return now;
}

/// Sets the ways that the link's limits leave open, and its mobility.
/// \param parent  orientation of the link above
/// \param torque  how the cost falls as the link turns
void open_ways(IkLink& link, const glm::dquat& parent, const glm::dvec3& torque, double spring);
/// Turns the link by its mobility times a torque, inside its limits.
void take_step(IkLink& link, const glm::dvec3& torque);
inline void take_step(IkLink& link, const LimitChart::Numbers& by) {
    link.before = link.local;
    link.numbers_before = link.chart.values();
    link.local = link.chart.step(link, by);
}
inline void take_back_step(IkLink& link) {
    if (link.chart.size() == 0) return;
    link.local = link.before;
    link.chart.set(link.numbers_before);
}
/// Returns [arm]x by columns, cross(arm, axis). A rotation w moves the end of an arm by cross(w, arm) = -[arm]x w.
inline glm::dmat3 cross_matrix(const glm::dvec3& arm) {
    return {glm::dvec3(0.0, arm.z, -arm.y), glm::dvec3(-arm.z, 0.0, arm.x), glm::dvec3(arm.y, -arm.x, 0.0)};
}

/// Iterates from the problem's current state until its targets are reached or it is stuck: Levenberg-Marquardt. Springs
/// to the pose that came in, which are loosened from step to step, are the damping; a step counts as better with them.
/// Returns the number of iterations.
/// \param problem  has is_reached(), measure(), take_step(spring, damping), and take_back_step()
template <class Problem>
std::uint32_t descend_damped(Problem& problem, std::uint32_t most) {
    constexpr double kSpring = 1e-2, kLooser = 0.1, kStuck = 1e-4;
    constexpr double kFirst = 1e-3, kHarder = 10.0, kHardest = 1e3;
    double spring = kSpring, more = 0.0;
    Measured at = problem.measure();
    for (std::uint32_t iteration = 0; iteration < most; ++iteration) {
        if (problem.is_reached()) return iteration;
        problem.take_step(spring, spring + more);
        const Measured now = problem.measure();
        const double before = at.objective(spring), gain = before - now.objective(spring);
        if (!(gain > 0.0)) {
            problem.take_back_step();
            if (more >= kHardest) return iteration + 1;
            more = std::max(kFirst, kHarder * more);
            continue;
        }
        at = now;
        const double last = at.last_spring();
        if (spring <= last && gain < kStuck * before) return iteration + 1;
        spring = std::max(last, kLooser * spring);
        more = more <= kFirst ? 0.0 : more / kHarder;
    }
    return most;
}

}  // namespace bendy
