#pragma once

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

/// The longest step of a joint in radians: beyond it the derivative is meaningless.
inline constexpr double kLongestStep = 1.0;

/// Sets the link's mobility from its freedom: from a wanted rotation vector to the one that it makes.
void set_mobility(IkLink& link);
/// Sets the link's trial from a step by a rotation, as far as it is legal. Returns true if a constraint stopped it in a
/// direction in which it was free so far: that direction is then removed from its mobility. \param parent  orientation
/// of the link above
bool try_rotation(IkLink& link, const glm::dquat& parent, const glm::dvec3& turn);
/// The second half of that, for a link whose trial has been limited otherwise.
bool take_stopped_direction(IkLink& link, const glm::dquat& parent, const glm::dquat& rotation);
/// Returns [arm]x by columns, cross(arm, axis). A rotation w moves the end of an arm by cross(w, arm) = -[arm]x w.
inline glm::dmat3 cross_matrix(const glm::dvec3& arm) {
    return {glm::dvec3(0.0, arm.z, -arm.y), glm::dvec3(-arm.z, 0.0, arm.x), glm::dvec3(arm.y, -arm.x, 0.0)};
}

/// Iterates from the problem's current state until its targets are reached or it is stuck: Levenberg-Marquardt. Returns
/// the number of iterations. \param problem  has is_reached(), cost(), try_step(damping), which leaves a step in the
/// trial state, and swap(), which makes the
///                 trial state the current one and the current one the trial state
template <class Problem>
std::uint32_t descend_damped(Problem& problem, std::uint32_t most) {
    double damping = 1e-2;
    double cost = problem.cost();
    for (std::uint32_t iteration = 0; iteration < most; ++iteration) {
        if (problem.is_reached()) return iteration;
        problem.try_step(damping);
        problem.swap();
        const double now = problem.cost();
        constexpr double kStuck = 1e-3;  // relative to the cost
        const bool is_better = now < cost;
        const bool is_stuck = cost - now < kStuck * cost;
        if (is_better) {
            cost = now;
            damping = std::max(damping * 0.3, 1e-9);
        } else {
            problem.swap();
            damping *= 8.0;
        }
        if (is_stuck && (is_better || damping > 10.0)) return iteration + 1;
    }
    return most;
}

/// Pseudo-random numbers in [-1, 1] from a counter: the same on every machine.
class Dice {
public:
    double next() {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;  // Knuth's MMIX generator
        return static_cast<double>(static_cast<std::int64_t>(state_) >> 11) * 0x1p-52;
    }

private:
    std::uint64_t state_ = 1;
};

}  // namespace bendy
