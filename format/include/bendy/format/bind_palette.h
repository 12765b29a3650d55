#pragma once

#include <bendy/format/public.h>
#include <bendy/format/records.h>

#include <glm/mat4x4.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace BENDY_PUBLIC bendy {

/// Computes the matrices from joint space to model space in the rest pose. `parents` has one entry per rest, each
/// smaller than its own index or kNone. Uses only addition, multiplication and division of doubles, so the result is
/// the same on every machine.
std::vector<glm::dmat4> rest_matrices(std::span<const RestRecord> rests, std::span<const std::uint32_t> parents);

/// Computes the inverse bind matrix of a joint that was bound in its rest pose: inverse(rest) * base. Not finite if the
/// rest matrix is singular.
glm::mat4 derive_inverse_bind(const glm::dmat4& rest, const glm::mat4& base);

}  // namespace bendy
