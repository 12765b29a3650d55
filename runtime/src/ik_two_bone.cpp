#include "ik_problem.h"
#include "rotation.h"
#include "trig.h"

#include <algorithm>
#include <cmath>

// Two bones in closed form: the middle joint turns until the tip is as far from the start as the target is, then the
// start turns the tip to the target, and about the line between them until the bend looks to the pole.
namespace bendy {
namespace {

double length_of(const glm::dvec3& v) {
    return std::sqrt(glm::dot(v, v));
}

/// The link that bends: the one that parts the chain most evenly.
std::size_t find_middle(const IkProblem& problem) {
    std::size_t middle = 0;
    double best = 0.0;
    for (std::size_t i = 1; i < problem.links.size(); ++i) {
        const glm::dvec3& position = problem.links[i].position;
        const double shorter = std::min(length_of(position - problem.origin), length_of(problem.tip - position));
        if (problem.links[i].is_fixed || shorter <= best) continue;
        best = shorter;
        middle = i;
    }
    return middle;
}

/// How far the tip should be from the start: the target's distance, slowed near full reach, where a straight leg would
/// snap: it then comes nearer by an exponential that never arrives.
double wanted_distance(double distance, double full, double softness) {
    const double zone = full * std::clamp(softness, 0.0, 1.0);
    const double hard = full - zone;
    if (zone <= 0.0 || distance <= hard) return distance;
    return hard + zone * (1.0 - std::exp(-(distance - hard) / zone));
}

/// The axis about which the middle joint bends, not of unit length.
glm::dvec3 bend_axis(const IkProblem& problem, const IkLink& middle, const glm::dvec3& u, const glm::dvec3& v) {
    if (middle.constraint != nullptr && middle.constraint->model == LimitModel::hinge)
        return middle.global * (middle.frame * glm::dvec3(1.0, 0.0, 0.0));
    const double size = length_of(u) * length_of(v);
    glm::dvec3 axis = glm::cross(u, v);
    constexpr double kStraight = 1e-6;
    if (length_of(axis) > kStraight * size) return axis;
    if (problem.has_pole) {
        axis = glm::cross(problem.pole - problem.origin, u);
        if (length_of(axis) > kStraight * length_of(u)) return axis;
    }
    // A straight chain bends the way its joint prefers, else about the more crosswise of its axes.
    const glm::dquat axes = middle.global * middle.frame;
    if (middle.constraint != nullptr) {
        const auto& preferred = middle.constraint->record.preferred;
        axis = axes * glm::dvec3(preferred[0], preferred[1], preferred[2]);
        axis -= u * (glm::dot(axis, u) / glm::dot(u, u));
        if (length_of(axis) > kStraight) return axis;
    }
    const glm::dvec3 x = glm::cross(u, axes * glm::dvec3(1.0, 0.0, 0.0));
    const glm::dvec3 z = glm::cross(u, axes * glm::dvec3(0.0, 0.0, 1.0));
    return glm::dot(x, x) > glm::dot(z, z) ? glm::cross(x, u) : glm::cross(z, u);
}

/// Turns the middle joint so that the tip is `distance` from the start, or as near to that as it gets.
void bend(IkProblem& problem, std::size_t middle, double distance) {
    const IkLink& link = problem.links[middle];
    const glm::dvec3 u = link.position - problem.origin;
    const glm::dvec3 v = problem.tip - link.position;
    glm::dvec3 h = bend_axis(problem, link, u, v);
    const double size = length_of(h);
    if (size < 1e-12) return;
    h /= size;
    // |u + turned v| = distance:  along + b cos(f) + c sin(f) = wanted, f the turn about h.
    const double wanted = 0.5 * (distance * distance - glm::dot(u, u) - glm::dot(v, v));
    const double along = glm::dot(u, h) * glm::dot(v, h);
    const glm::dvec3 across = v - h * glm::dot(v, h);
    const double b = glm::dot(u, across);
    const double c = glm::dot(u, glm::cross(h, across));
    const double most = std::sqrt(b * b + c * c);
    if (most < 1e-12) return;
    const double straight = trig::atan2(c, b);
    const double opening = trig::acos((wanted - along) / most);
    const auto nearer_to_none = [](double angle) { return std::remainder(angle, 2.0 * trig::kPi); };
    double turn = nearer_to_none(straight - opening);
    const double other = nearer_to_none(straight + opening);
    const auto illegality = [&](double angle) {
        const glm::dquat parent = problem.parent_global(middle);
        const glm::dquat local = glm::normalize(glm::conjugate(parent) * from_vector(h * angle) * link.global);
        return link.constraint == nullptr ? 0.0 : angle_between(legal_local(link, local), local);
    };
    const double excess = illegality(turn) - illegality(other);
    constexpr double kSame = 1e-6;
    if (excess > kSame || (excess > -kSame && std::abs(other) < std::abs(turn))) turn = other;
    turn_link(problem, middle, h * turn);
    problem.place(middle);
}

/// Turns the whole chain about the line from start to tip until the middle joint is on the pole's side.
void turn_to_pole(IkProblem& problem, std::size_t middle) {
    const glm::dvec3 line = problem.tip - problem.origin;
    const double size = length_of(line);
    if (size < 1e-12) return;
    const glm::dvec3 axis = line / size;
    const auto across = [&](const glm::dvec3& point) {
        const glm::dvec3 v = point - problem.origin;
        return v - axis * glm::dot(axis, v);
    };
    const glm::dvec3 knee = across(problem.links[middle].position);
    const glm::dvec3 pole = across(problem.pole);
    if (length_of(knee) < 1e-9 || length_of(pole) < 1e-9) return;
    const double angle = trig::atan2(glm::dot(axis, glm::cross(knee, pole)), glm::dot(knee, pole)) + problem.pole_angle;
    turn_link(problem, 0, axis * angle);
    problem.place();
}

}  // namespace

std::uint32_t solve_two_bone(IkProblem& problem) {
    const std::size_t middle = find_middle(problem);
    if (middle == 0) return solve_ccd(problem);  // there are no two bones
    const glm::dvec3& knee = problem.links[middle].position;
    const double full = length_of(knee - problem.origin) + length_of(problem.tip - knee);
    const double distance = length_of(problem.target - problem.origin);
    bend(problem, middle, wanted_distance(distance, full, problem.options->softness));
    turn_link(problem, 0, to_vector(between(problem.tip - problem.origin, problem.target - problem.origin)));
    problem.place();
    if (problem.has_pole) turn_to_pole(problem, middle);
    const std::size_t last = problem.links.size() - 1;
    if (problem.has_rotation && last > middle && problem.links[last].bone_length == 0.0) {
        turn_link(problem, last, to_vector(problem.target_rotation * glm::conjugate(problem.tip_global)));
        problem.place(last);
    }
    return 1;
}

}  // namespace bendy
