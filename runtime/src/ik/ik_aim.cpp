#include "ik_problem.h"
#include "math/rotation.h"

#include <bendy/format/trig.h>

#include <cmath>

// Looking at a target: turns the tip's Z axis towards it. Each joint does its share of the remaining rotation, and the
// last one all of it, so that a neck and a head turn together.
namespace bendy {
namespace {

/// The rotation from the tip's current direction to the wanted one.
glm::dvec3 turn_left(const IkProblem& problem) {
    return to_vector(between(problem.tip_global * glm::dvec3(0.0, 0.0, 1.0), problem.target - problem.tip));
}

/// The rotation about the line of sight that brings the tip's Y axis up to the pole.
glm::dvec3 roll_left(const IkProblem& problem) {
    const glm::dvec3 forward = problem.tip_global * glm::dvec3(0.0, 0.0, 1.0);
    const auto across = [&](const glm::dvec3& v) { return v - forward * glm::dot(forward, v); };
    const glm::dvec3 up = across(problem.tip_global * glm::dvec3(0.0, 1.0, 0.0));
    const glm::dvec3 wanted = across(problem.pole - problem.tip);
    const double y = glm::dot(forward, glm::cross(up, wanted));
    return forward * (trig::atan2(y, glm::dot(up, wanted)) + problem.pole_angle);
}

}  // namespace

std::uint32_t solve_aim(IkProblem& problem) {
    const std::uint32_t most = problem.iterations != 0 ? problem.iterations : 20;
    const std::size_t links = problem.links.size();
    constexpr std::uint32_t kLeast = 4;  // then it ends where limits stop it
    double before = 0.0;
    for (std::uint32_t iteration = 0; iteration < most; ++iteration) {
        const glm::dvec3 left = turn_left(problem);
        const glm::dvec3 roll = problem.has_pole ? roll_left(problem) : glm::dvec3(0.0);
        const double angle = std::sqrt(glm::dot(left, left) + glm::dot(roll, roll));
        const bool is_stuck = iteration >= kLeast && angle > before - 0.1 * problem.tolerance;
        if (angle <= problem.tolerance || is_stuck) return iteration;
        before = angle;
        for (std::size_t i = 0; i < links; ++i) {
            if (problem.links[i].is_fixed) continue;
            const double share = iteration == 0 ? 1.0 / static_cast<double>(links - i) : 1.0;
            turn_link(problem, i, from_vector(share * turn_left(problem)));
            problem.place(i);
            if (problem.has_pole) {
                turn_link(problem, i, from_vector(share * roll_left(problem)));
                problem.place(i);
            }
        }
    }
    return most;
}

}  // namespace bendy
