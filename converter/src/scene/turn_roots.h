#pragma once

#include <bendy/converter/scene.h>

#include <glm/mat3x3.hpp>

namespace bendy::converter {

/// Turns the whole scene about the origin: the rest transforms of its roots, their tracks, and what else is in model
/// space. Everything that is relative to a joint stays as it is. Numbers are permuted and negated, not rounded, except
/// those of quaternions. \param turn  a rotation by a multiple of 90 degrees about an axis: of each row and column, one
/// number is 1 or -1
void turn_roots(Scene& scene, const glm::dmat3& turn);

}  // namespace bendy::converter
