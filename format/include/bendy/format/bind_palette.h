#pragma once

#include <bendy/format/public.h>
#include <bendy/format/records.h>

#include <glm/mat4x4.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace BENDY_PUBLIC bendy {

/// Matrices from joint space to model space in the rest pose. `parents` as many as rests, each smaller than its own
/// index or kNone. Additions, multiplications and divisions of doubles alone, so the same on every machine.
std::vector<glm::dmat4> rest_matrices(std::span<const RestRecord> rests, std::span<const std::uint32_t> parents);

/// The inverse bind matrix of a joint that was bound in its rest pose: inverse(rest) * base. Not finite where the rest
/// pose has no volume.
glm::mat4 derive_inverse_bind(const glm::dmat4& rest, const glm::mat4& base);

}  // namespace bendy
