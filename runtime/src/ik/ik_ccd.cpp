#include "ik_problem.h"
#include "math/rotation.h"

// Cyclic coordinate descent (Wang and Chen, "A combined optimization method for solving the inverse kinematics problem
// of mechanical manipulators", 1991): from the tip up, each joint in turn brings the tip as near to the target as it
// can.
namespace bendy {
namespace {

/// The rotation of one joint that brings the tip nearest to the target, including its orientation if that counts.
glm::dquat best_turn(const IkProblem& problem, const IkLink& link, const glm::dvec3& tip,
                     const glm::dquat& tip_global) {
    const glm::dvec3 arm = tip - link.position;
    const glm::dvec3 to_target = problem.target - link.position;
    if (!problem.has_rotation) return between(arm, to_target);
    // The least-squares solution of: cross(turn, arm) = remaining offset, turn = remaining rotation.
    const double p = problem.position_weight;
    const double r = problem.rotation_weight;
    const glm::dmat3 A = glm::dmat3(p * glm::dot(arm, arm) + r + 1e-9) - p * glm::outerProduct(arm, arm);
    const glm::dvec3 rotation_left = to_vector(problem.target_rotation * glm::conjugate(tip_global));
    return from_vector(glm::inverse(A) * (p * glm::cross(arm, problem.target - tip) + r * rotation_left));
}

}  // namespace

std::uint32_t solve_ccd(IkProblem& problem) {
    const std::uint32_t most = problem.iterations != 0 ? problem.iterations : 100;
    double last = problem.cost();
    for (std::uint32_t iteration = 0; iteration < most; ++iteration) {
        if (problem.is_reached()) return iteration;
        glm::dvec3 tip = problem.tip;
        glm::dquat tip_global = problem.tip_global;
        for (std::size_t i = problem.links.size(); i-- > 0;) {
            const IkLink& link = problem.links[i];
            if (link.is_fixed) continue;
            const glm::dquat turned = turn_link(problem, i, best_turn(problem, link, tip, tip_global));
            tip = link.position + turned * (tip - link.position);
            tip_global = turned * tip_global;
        }
        problem.place();
        const double now = problem.cost();
        constexpr double kStuck = 1e-9;  // of the cost, each round
        if (last - now < kStuck * last) return iteration + 1;
        last = now;
    }
    return most;
}

}  // namespace bendy
