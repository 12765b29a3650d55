#include "ik_problem.h"
#include "math/rotation.h"

#include <bendy/format/trig.h>

#include <algorithm>
#include <cmath>

// Forward and backward reaching (Aristidou and Lasenby, "FABRIK: a fast, iterative solver for the inverse kinematics
// problem", 2011). The backward pass moves each joint to where its bone, which keeps its length, should begin; the
// forward pass turns each bone to where its end should be. Both passes respect the constraints. If these stop it short
// of the target, least squares continues (ik.cpp).
namespace bendy {
namespace {

bool turns_by_orientation(const IkProblem& problem, std::size_t link) {
    return link + 1 == problem.links.size() && problem.has_rotation && problem.rotation_weight > 0.0;
}

/// Returns the next link that can turn, or the number of links. The links between move with this one as a single bone.
std::size_t next_moving(const IkProblem& problem, std::size_t link) {
    do ++link;
    while (link < problem.links.size() && problem.links[link].is_fixed);
    return link;
}

glm::dvec3 position_of(const IkProblem& problem, std::size_t link) {
    return link < problem.links.size() ? problem.links[link].position : problem.tip;
}

/// Computes where each moving link should be if the tip were at the target: from the tip up to the start.
void reach_backwards(IkProblem& problem) {
    glm::dvec3 end = problem.target;
    glm::dvec3 end_now = problem.tip;
    for (std::size_t i = problem.links.size(); i-- > 0;) {
        IkLink& link = problem.links[i];
        if (link.is_fixed) continue;
        const glm::dvec3 bone = end_now - link.position;
        glm::dvec3 back = link.position - end;
        // The direction of the last bone follows from the target's orientation.
        if (turns_by_orientation(problem, i))
            back = -(problem.target_rotation * glm::conjugate(problem.tip_global)) * bone;
        const double length = glm::length(back);
        end += length > 1e-12 ? back * (glm::length(bone) / length) : -bone;
        link.goal = end;  // of the link itself
        end_now = link.position;
    }
}

/// The same within the constraints: turns each link towards the end of its bone, then back to where the next link,
/// which is already placed, is legal. The link's orientation is stored in its trial.
void reach_backwards_legally(IkProblem& problem) {
    glm::dvec3 end = problem.target;
    glm::dvec3 end_now = problem.tip;
    std::size_t next = problem.links.size();  // the moving link that is already placed
    for (std::size_t i = problem.links.size(); i-- > 0;) {
        IkLink& link = problem.links[i];
        if (link.is_fixed) continue;
        const glm::dvec3 bone = end_now - link.position;
        link.trial = link.global;
        if (turns_by_orientation(problem, i)) {
            link.trial = problem.target_rotation * glm::conjugate(problem.tip_global) * link.global;
        } else if (glm::dot(bone, bone) > 1e-24) {
            link.trial = between(bone, end - link.position) * link.global;
        }
        if (next < problem.links.size() && problem.links[next].constraint != nullptr) {
            const IkLink& after = problem.links[next];
            const glm::dquat held = glm::conjugate(link.global) * problem.parent_global(next);  // through fixed links
            const glm::dquat legal = legal_local(after, glm::conjugate(link.trial * held) * after.trial);
            link.trial = glm::normalize(after.trial * glm::conjugate(held * legal));
        }
        end -= link.trial * (glm::conjugate(link.global) * bone);
        link.goal = end;
        end_now = link.position;
        if (glm::dot(bone, bone) > 1e-24 || turns_by_orientation(problem, i)) next = i;
    }
}

/// A hinge, or a swing of zero width, bends in one plane only. Rotates the bone before it about itself until that plane
/// contains the hinge's goal.
void twist_for_hinge(IkProblem& problem, std::size_t i, std::size_t next) {
    if (next == problem.links.size()) return;
    const IkLink& link = problem.links[i];
    const IkLink& hinged = problem.links[next];
    const glm::dvec3 own = hinged.constraint == nullptr ? glm::dvec3(0.0) : only_axis(*hinged.constraint);
    if (own == glm::dvec3(0.0)) return;
    const glm::dvec3 bone = hinged.position - link.position;
    const double length = glm::length(bone);
    if (length < 1e-9) return;
    const glm::dvec3 axis = bone / length;
    const glm::dvec3 hinge = problem.parent_global(next) * (hinged.rest_frame * own);
    const std::size_t after = next_moving(problem, next);
    const glm::dvec3 goal = after == problem.links.size() ? problem.target : problem.links[after].goal;
    const glm::dvec3 way = goal - hinged.position;
    // The hinge's axis, rotated by f, perpendicular to the way: along + a cos(f) + b sin(f) = 0.
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
    turn_link(problem, i, from_vector(axis * (std::abs(one) < std::abs(other) ? one : other)));
}

void reach_forwards(IkProblem& problem) {
    const std::size_t links = problem.links.size();
    std::size_t i = problem.links[0].is_fixed ? next_moving(problem, 0) : 0;
    while (i < links) {
        const std::size_t next = next_moving(problem, i);
        const auto place = [&] {
            for (std::size_t j = i; j < next; ++j) problem.place_next(j);
        };
        place();
        if (turns_by_orientation(problem, i)) {
            turn_link(problem, i, problem.target_rotation * glm::conjugate(problem.tip_global));
        } else {
            const glm::dvec3& position = problem.links[i].position;
            const glm::dvec3 goal = next == links ? problem.target : problem.links[next].goal;
            turn_link(problem, i, between(position_of(problem, next) - position, goal - position));
            place();
            twist_for_hinge(problem, i, next);
        }
        place();
        i = next;
    }
}

}  // namespace

std::uint32_t solve_fabrik(IkProblem& problem) {
    const std::uint32_t most = problem.iterations != 0 ? problem.iterations : 100;
    const bool is_limited = std::any_of(problem.links.begin(), problem.links.end(),
                                        [](const IkLink& link) { return link.constraint != nullptr; });
    // With constraints, another solver takes over if progress is slow.
    const double least_gain = is_limited ? 0.1 : 1e-6;  // relative to the cost
    const std::uint32_t patience = is_limited ? 4 : 8;
    double best = problem.cost();
    problem.save();
    std::uint32_t without_gain = 0;
    for (std::uint32_t iteration = 0; iteration < most; ++iteration) {
        if (problem.is_reached()) return iteration;
        is_limited ? reach_backwards_legally(problem) : reach_backwards(problem);
        reach_forwards(problem);
        problem.place();
        const double now = problem.cost();
        if (now < best) {
            without_gain = best - now < least_gain * best ? without_gain + 1 : 0;
            best = now;
            problem.save();
        } else {
            ++without_gain;
        }
        if (without_gain >= patience) {
            problem.restore();
            return iteration + 1;
        }
    }
    problem.restore();
    return most;
}

}  // namespace bendy
