#include "damped_step.h"

#include "ik_problem.h"
#include "math/rotation.h"

#include <algorithm>
#include <cmath>

namespace bendy {
bool take_stopped_direction(IkLink& link, const glm::dquat& parent, const glm::dquat& rotation) {
    const glm::dquat done = upper_half(parent * link.trial * glm::conjugate(link.global));
    // Approximately half the rotation vectors.
    const glm::dvec3 turn(rotation.x, rotation.y, rotation.z);
    const glm::dvec3 stopped = turn - glm::dvec3(done.x, done.y, done.z);
    const double size = glm::dot(stopped, stopped);
    constexpr double kPart = 0.05;  // fraction of the rotation
    if (size <= kPart * kPart * glm::dot(turn, turn)) return false;
    const glm::dvec3 moved = link.mobility * stopped;
    const double weight = glm::dot(stopped, moved);
    if (weight <= 1e-12 * size) return false;
    link.mobility -= glm::outerProduct(moved, moved) / weight;
    return true;
}

void solve_damped(double* A, std::size_t stride, std::size_t size, double damping, double* y) {
    for (std::size_t j = 0; j < size; ++j) {
        const double* const row = A + j * stride;
        double diagonal = row[j] + damping;
        for (std::size_t k = 0; k < j; ++k) diagonal -= row[k] * row[k];
        A[j * stride + j] = std::sqrt(std::max(diagonal, 1e-30));
        for (std::size_t i = j + 1; i < size; ++i) {
            double* const other = A + i * stride;
            double sum = other[j];
            for (std::size_t k = 0; k < j; ++k) sum -= other[k] * row[k];
            other[j] = sum / row[j];
        }
    }
    for (std::size_t i = 0; i < size; ++i) {
        for (std::size_t k = 0; k < i; ++k) y[i] -= A[i * stride + k] * y[k];
        y[i] /= A[i * stride + i];
    }
    for (std::size_t i = size; i-- > 0;) {
        for (std::size_t k = i + 1; k < size; ++k) y[i] -= A[k * stride + i] * y[k];
        y[i] /= A[i * stride + i];
    }
}

void set_mobility(IkLink& link) {
    const glm::dmat3 axes = glm::mat3_cast(link.global * link.frame);
    const glm::dvec3 squares = link.freedom * link.freedom;
    link.mobility = glm::dmat3(axes[0] * squares.x, axes[1] * squares.y, axes[2] * squares.z) * glm::transpose(axes);
}

bool try_rotation(IkLink& link, const glm::dquat& parent, const glm::dvec3& turn) {
    const double size = std::sqrt(glm::dot(turn, turn));
    const glm::dquat rotation = from_vector(size > kLongestStep ? turn * (kLongestStep / size) : turn);
    link.trial = softly_legal_local(link, glm::normalize(glm::conjugate(parent) * (rotation * link.global)));
    return link.constraint != nullptr && size > 0.0 && take_stopped_direction(link, parent, rotation);
}

}  // namespace bendy
