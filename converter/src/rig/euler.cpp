#include "euler.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>

namespace bendy::converter {

std::array<std::size_t, 3> axes_of(EulerOrder order) {
    constexpr std::array<std::array<std::size_t, 3>, kEulerOrders> kAxes{
        {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
    return kAxes[static_cast<std::size_t>(order)];
}

std::array<double, 3> to_euler(const Rotation& rotation, EulerOrder order) {
    const auto [first, middle, last] = axes_of(order);
    const glm::dmat3 columns = glm::mat3_cast(rotation);
    const auto entry = [&](std::size_t row, std::size_t column) {
        return columns[static_cast<int>(column)][static_cast<int>(row)];
    };
    const double sign = (first + 1) % 3 == middle ? 1.0 : -1.0;  // of the axes' permutation
    std::array<double, 3> angles{};
    angles[first] = std::atan2(sign * entry(last, middle), entry(last, last));
    angles[middle] = std::asin(std::clamp(-sign * entry(last, first), -1.0, 1.0));
    angles[last] = std::atan2(sign * entry(middle, first), entry(first, first));
    return angles;
}

}  // namespace bendy::converter
