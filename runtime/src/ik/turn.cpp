#include <bendy/runtime/turn.h>

#include "math/rotation.h"

#include <bendy/format/trig.h>
#include <bendy/runtime/constrain.h>

#include <glm/geometric.hpp>

#include <cmath>
#include <utility>

namespace bendy {
namespace {

/// Returns the legal rotation, and by what the joint is turned beyond it.
std::pair<glm::dquat, glm::dquat> split(const Constraint& constraint, const glm::quat& rest, const glm::quat& local) {
    const glm::dquat R = to_constraint_space(constraint, rest, local);
    const glm::dquat legal = clamp_rotation(constraint, R);
    return {legal, glm::conjugate(legal) * R};
}

}  // namespace

double turn_between(const glm::quat& a, const glm::quat& b) {
    const glm::dquat by = glm::conjugate(glm::dquat(a)) * glm::dquat(b);
    return 2.0 * trig::atan2(glm::length(glm::dvec3(by.x, by.y, by.z)), std::abs(by.w));
}

glm::quat turn_part_way(const Constraint* constraint, const glm::quat& rest, const glm::quat& from, const glm::quat& to,
                        double share) {
    if (constraint == nullptr) {
        const glm::quat way(between(glm::dquat(from), glm::dquat(to), share));
        return way;
    }
    const auto [legal_from, beyond_from] = split(*constraint, rest, from);
    const auto [legal_to, beyond_to] = split(*constraint, rest, to);
    const glm::dquat R =
        between_legal(*constraint, legal_from, legal_to, share) * between(beyond_from, beyond_to, share);
    return from_constraint_space(*constraint, rest, R);
}

glm::quat turn_towards(const Constraint* constraint, const glm::quat& rest, const glm::quat& from, const glm::quat& to,
                       double most) {
    if (turn_between(from, to) <= most) return to;
    constexpr int kHalvings = 12;
    double low = 0.0, high = 1.0;
    for (int k = 0; k < kHalvings; ++k) {
        const double middle = 0.5 * (low + high);
        (turn_between(from, turn_part_way(constraint, rest, from, to, middle)) <= most ? low : high) = middle;
    }
    return turn_part_way(constraint, rest, from, to, low);
}

}  // namespace bendy
