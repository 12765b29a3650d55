#include "compact/largest_stretch.h"

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace bendy::converter {

double largest_stretch(const glm::dmat4& matrix) {
    // Power iteration on M^T M from three starts; each gives a lower bound that soon is tight.
    const glm::dmat3 linear(matrix);
    const glm::dmat3 square = glm::transpose(linear) * linear;
    double largest = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 v(0.3, 0.4, 0.5);
        v[axis] = 1.0;
        double length = 0.0;
        for (int turn = 0; turn < 24; ++turn) {
            v /= std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
            v = square * v;
            length = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
            if (!(length > 0.0) || !std::isfinite(length)) break;
        }
        largest = std::max(largest, length);
    }
    constexpr double kSpare = 1.001;
    return std::sqrt(largest) * kSpare;
}

}  // namespace bendy::converter
