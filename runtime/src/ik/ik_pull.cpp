#include "ik_problem.h"
#include "math/rotation.h"

#include <algorithm>
#include <cmath>

// E. F. Anderson's "pull" solver, after Hugo Elias: a force F pulls the tip towards the target; for each joint from the
// tip up, and each of its axes A, with B the vector from the joint to the tip,
//     angle = gain * |F| * sin(A, F) * sin(B, F) * sign((A x B) . F)
// In the paper B is the joint's own bone; the vector to the tip is the same for the last joint and correct for the
// others.
namespace bendy {

std::uint32_t solve_pull(IkProblem& problem) {
    const std::uint32_t steps = problem.iterations != 0 ? problem.iterations : 1;
    const double gain = problem.options->gain;
    const double step_limit = problem.options->step_limit;
    for (std::uint32_t step = 0; step < steps; ++step) {
        if (problem.is_reached()) return step;
        glm::dvec3 tip = problem.tip;
        for (std::size_t i = problem.links.size(); i-- > 0;) {
            const IkLink& link = problem.links[i];
            const glm::dvec3 F = problem.target - tip;
            const glm::dvec3 B = tip - link.position;
            const double force = glm::length(F);
            const double arm = glm::length(B);
            if (link.is_fixed || force < 1e-12 || arm < 1e-12) continue;
            const glm::dvec3 across = glm::cross(B, F) / (arm * force);
            const double sine_b = glm::length(across);
            glm::dvec3 turn(0.0);
            for (int axis = 0; axis < 3; ++axis) {
                glm::dvec3 A(0.0);
                A[axis] = 1.0;
                A = link.global * (link.frame * A);
                const glm::dvec3 side = glm::cross(A, F) / force;
                const double sine_a = glm::length(side);
                const double along = glm::dot(glm::cross(A, B), F);
                const double sign = along > 0.0 ? 1.0 : along < 0.0 ? -1.0 : 0.0;
                turn += A * (gain * force * sine_a * sine_b * sign);
            }
            const double size = glm::length(turn);
            if (size > step_limit) turn *= step_limit / size;
            const glm::dquat turned = turn_link(problem, i, from_vector(turn));
            tip = link.position + turned * B;
        }
        problem.place();
    }
    return steps;
}

}  // namespace bendy
