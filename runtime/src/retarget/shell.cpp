#include "shell.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace bendy {
namespace {

constexpr std::size_t kNowhere = 13;

}  // namespace

glm::dvec3 direction(std::size_t number) {
    const auto k = static_cast<int>(number);
    const glm::dvec3 way(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
    return number == kNowhere ? way : way / std::sqrt(glm::dot(way, way));
}

void Shell::take(const glm::dvec3& place) {
    for (std::size_t k = 0; k < kDirections; ++k) {
        const double here = glm::dot(place, direction(k));
        reach[k] = is_empty_ ? here : std::max(reach[k], here);
    }
    is_empty_ = false;
}

bool Shell::finish() {
    constexpr double kLeast = 1e-6;  // metres
    constexpr std::array<std::size_t, 3> kPlus{14, 16, 22}, kMinus{12, 10, 4};
    for (int axis = 0; axis < 3; ++axis) {
        const double plus = reach[kPlus[static_cast<std::size_t>(axis)]];
        const double minus = reach[kMinus[static_cast<std::size_t>(axis)]];
        middle[axis] = 0.5 * (plus - minus);
        half[axis] = 0.5 * (plus + minus);
    }
    for (std::size_t k = 0; k < kDirections; ++k) reach[k] -= glm::dot(middle, direction(k));
    return half.x > kLeast && half.y > kLeast && half.z > kLeast;
}

double Shell::gap(const glm::dvec3& way) const {
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < kDirections; ++k) {
        if (k != kNowhere) most = std::max(most, glm::dot(way, direction(k)) - reach[k]);
    }
    return most;
}

double Shell::radius(const glm::dvec3& side, double gap) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < kDirections; ++k) {
        const double along = glm::dot(side, direction(k));
        if (along > 0.0) least = std::min(least, std::max(reach[k] + gap, 0.0) / along);
    }
    return least;
}

}  // namespace bendy
