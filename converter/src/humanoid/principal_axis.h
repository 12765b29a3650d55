#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace bendy::converter {

/// The unit eigenvector of a symmetric matrix that belongs to its largest eigenvalue; of equal ones the first axis'. By
/// Jacobi's rotations, with no function but the square root: the same on every machine. X of a matrix of zeros.
glm::dvec3 principal_axis(const glm::dmat3& symmetric);

}  // namespace bendy::converter
