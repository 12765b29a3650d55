#pragma once

#include "scene/stored_numbers.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <optional>
#include <span>

namespace bendy::converter {

/// Numbers as steps from each component's minimum, in u8 or u16, or in u32 of up to 24 bits if `allow_wide`.
/// \param values      elements * components, finite
/// \param most_error  largest distance of an element from its value, over all its components; 0 or more
/// \return nothing if there are not enough steps, or floats are too coarse to decode with
std::optional<StoredStream> quantise_boxed(std::span<const float> values, std::uint32_t components, double most_error,
                                           bool allow_wide = false);

/// Displacements in equal steps, as i8 or i16. Zero stays exactly zero.
std::optional<StoredStream> quantise_shifts(std::span<const glm::vec3> shifts, double most_error);

/// Unit vectors and zeros in octahedral encoding with `bits` (2 to 16) per coordinate; nothing if one has another
/// length.
std::optional<StoredStream> quantise_normals(std::span<const glm::vec3> normals, unsigned bits);
/// As above, with the sign w, which must be 1 or -1.
std::optional<StoredStream> quantise_tangents(std::span<const glm::vec4> tangents, unsigned bits);

/// Numbers from 0 to 1 as u8; nothing if one is outside.
std::optional<StoredStream> quantise_colours(std::span<const float> values, std::uint32_t components);

/// Each vertex's weights as integers with the exact sum `levels`; the largest remainders are rounded up first.
/// `weights` sum to 1 and are not negative.
void quantise_weights(std::span<const float> weights, std::uint32_t levels, std::span<std::uint32_t> out);

/// Stores integer weights; `levels`, 255 to 65535, means 1.
StoredStream store_weights(std::span<const std::uint32_t> weights, std::uint32_t influences, std::uint32_t levels);

}  // namespace bendy::converter
