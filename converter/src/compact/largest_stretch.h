#pragma once

#include <glm/mat4x4.hpp>

namespace bendy::converter {

/// The largest factor by which the matrix lengthens a vector.
double largest_stretch(const glm::dmat4& matrix);

}  // namespace bendy::converter
