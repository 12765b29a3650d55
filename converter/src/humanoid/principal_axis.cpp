#include "principal_axis.h"

#include <glm/matrix.hpp>

#include <cmath>
#include <utility>

namespace bendy::converter {

glm::dvec3 principal_axis(const glm::dmat3& symmetric) {
    glm::dmat3 m = symmetric;
    glm::dmat3 axes(1.0);
    constexpr int kSweeps = 12;  // it converges quadratically: five are enough for 1e-15
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
        for (const auto& [p, q] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)}) {
            if (m[p][q] == 0.0) continue;
            const double theta = (m[q][q] - m[p][p]) / (2.0 * m[p][q]);
            const double t = (theta < 0.0 ? -1.0 : 1.0) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
            const double c = 1.0 / std::sqrt(t * t + 1.0);
            const double s = t * c;
            glm::dmat3 turn(1.0);
            turn[p][p] = turn[q][q] = c;
            turn[q][p] = s;
            turn[p][q] = -s;
            m = glm::transpose(turn) * m * turn;
            m[p][q] = m[q][p] = 0.0;
            axes = axes * turn;
        }
    }
    int largest = 0;
    for (const int axis : {1, 2}) {
        if (m[axis][axis] > m[largest][largest]) largest = axis;
    }
    const glm::dvec3& axis = axes[largest];
    const double length = std::sqrt(axis.x * axis.x + axis.y * axis.y + axis.z * axis.z);
    return std::isfinite(length) && length > 0.5 ? axis / length : glm::dvec3(1.0, 0.0, 0.0);
}

}  // namespace bendy::converter
