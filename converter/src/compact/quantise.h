#pragma once

#include "stored_numbers.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <optional>
#include <span>

namespace bendy::converter {

/// Numbers in steps from each component's smallest one, as u8 or u16, or u32 of up to 24 bits if `allow_wide`.
/// \param values      elements * components, finite
/// \param most_error  largest distance of an element from its value, over all its components; 0 or more
/// \return nothing if the steps do not reach, or floats are too coarse to decode with
std::optional<StoredStream> quantise_boxed(std::span<const float> values, std::uint32_t components, double most_error,
                                           bool allow_wide = false);

/// Displacements in equal steps, as i8 or i16: what is zero stays zero, to the bit.
std::optional<StoredStream> quantise_shifts(std::span<const glm::vec3> shifts, double most_error);

/// Unit vectors and zeros as points of the octahedron with `bits` (2 to 16) each; nothing if one has another length.
std::optional<StoredStream> quantise_normals(std::span<const glm::vec3> normals, unsigned bits);
/// The same, and the sign w, which must be 1 or -1.
std::optional<StoredStream> quantise_tangents(std::span<const glm::vec4> tangents, unsigned bits);

/// Numbers of 0 to 1 as u8; nothing if one is outside.
std::optional<StoredStream> quantise_colours(std::span<const float> values, std::uint32_t components);

/// Each vertex's weights as whole numbers with the sum `levels` exactly; what is largest after rounding down is rounded
/// up first. `weights` sum to 1 and are not negative.
void quantise_weights(std::span<const float> weights, std::uint32_t levels, std::span<std::uint32_t> out);

/// Integers of which `levels`, 255 to 65535, stand for 1.
StoredStream store_weights(std::span<const std::uint32_t> weights, std::uint32_t influences, std::uint32_t levels);

}  // namespace bendy::converter
