#include "ik_problem.h"
#include "rotation.h"
#include "trig.h"

#include <cmath>

// Forward and backward reaching (Aristidou and Lasenby, "FABRIK: a fast, iterative solver for the inverse kinematics
// problem", 2011). Backwards the joints move freely, each keeping its bone's length; forwards each bone is turned to
// where its end should be, as far as its constraint lets it.
namespace bendy {
namespace {

/// Where each link should be if the tip were at the target: from the tip up to the start.
void reach_backwards(IkProblem& problem) {
    glm::dvec3 end = problem.target;
    for (std::size_t i = problem.links.size(); i-- > 0;) {
        IkLink& link = problem.links[i];
        const bool is_last = i + 1 == problem.links.size();
        glm::dvec3 back = link.position - end;
        if (is_last && problem.has_rotation && problem.rotation_weight > 0.0) {
            // The last bone should lie as the target's orientation has it.
            const glm::dquat wanted = problem.target_rotation * glm::conjugate(problem.tip_rotation);
            back = -(wanted * link.bone);
        }
        const double length = std::sqrt(glm::dot(back, back));
        if (length > 1e-12) {
            end += back * (link.bone_length / length);
        } else {
            end -= link.global * link.bone;
        }
        link.goal = end;  // of the link itself
    }
}

/// A hinge bends in one plane only. Turns the bone before it about itself, until that plane holds the hinge's goal.
void twist_for_hinge(IkProblem& problem, std::size_t i) {
    const IkLink& link = problem.links[i];
    const IkLink& next = problem.links[i + 1];
    if (next.constraint == nullptr || next.constraint->model != LimitModel::hinge) return;
    const glm::dvec3 axis = (link.global * link.bone) / link.bone_length;
    const glm::dvec3 hinge = link.global * (next.rest_frame * glm::dvec3(1.0, 0.0, 0.0));
    const bool is_tip = i + 2 == problem.links.size();
    const glm::dvec3 way = (is_tip ? problem.target : problem.links[i + 2].goal) - (link.position + axis * link.bone_length);
    // The hinge's axis, turned by f, across the way: along + a cos(f) + b sin(f) = 0.
    const double along = glm::dot(axis, hinge) * glm::dot(axis, way);
    const glm::dvec3 side = hinge - axis * glm::dot(axis, hinge);
    const double a = glm::dot(side, way);
    const double b = glm::dot(glm::cross(axis, side), way);
    const double most = std::sqrt(a * a + b * b);
    if (most < 1e-9) return;
    const double middle = trig::atan2(b, a);
    const double opening = trig::acos(-along / most);
    const double one = std::remainder(middle - opening, 2.0 * trig::kPi);
    const double other = std::remainder(middle + opening, 2.0 * trig::kPi);
    turn_link(problem, i, axis * (std::abs(one) < std::abs(other) ? one : other));
}

void reach_forwards(IkProblem& problem) {
    const std::size_t last = problem.links.size() - 1;
    for (std::size_t i = 0; i <= last; ++i) {
        const IkLink& link = problem.links[i];
        const bool turns_by_orientation = i == last && problem.has_rotation && problem.rotation_weight > 0.0;
        if (turns_by_orientation) {
            const glm::dquat tip_global = link.global * problem.tip_rotation;
            turn_link(problem, i, problem.target_rotation * glm::conjugate(tip_global));
        } else if (link.bone_length > 0.0 && !link.is_fixed) {
            const glm::dvec3 goal = i == last ? problem.target : problem.links[i + 1].goal;
            turn_link(problem, i, between(link.global * link.bone, goal - link.position));
            if (i < last) twist_for_hinge(problem, i);
        }
        problem.place_next(i);
    }
}

}  // namespace

std::uint32_t solve_fabrik(IkProblem& problem) {
    const std::uint32_t most = problem.iterations != 0 ? problem.iterations : 100;
    double best = problem.cost();
    problem.save();
    std::uint32_t without_gain = 0;
    for (std::uint32_t iteration = 0; iteration < most; ++iteration) {
        if (problem.is_reached()) return iteration;
        reach_backwards(problem);
        reach_forwards(problem);
        const double now = problem.cost();
        constexpr double kGain = 1e-6;  // of the cost
        constexpr std::uint32_t kPatience = 8;
        if (now < best) {
            without_gain = best - now < kGain * best ? without_gain + 1 : 0;
            best = now;
            problem.save();
        } else {
            ++without_gain;
        }
        if (without_gain >= kPatience) {
            problem.restore();
            return iteration + 1;
        }
    }
    problem.restore();
    return most;
}

}  // namespace bendy
