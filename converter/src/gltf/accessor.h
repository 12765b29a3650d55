#pragma once

#include "document.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace bendy::converter::gltf {

/// The most elements that an accessor without stored data may imply (zeros, with or without sparse values).
inline constexpr std::uint64_t kMaxImpliedElements = std::uint64_t{1} << 24;

/// Components of one element: SCALAR 1 to MAT4 16.
std::size_t component_count(const tinygltf::Accessor& accessor);

/// Bytes of one component of this glTF type code.
std::size_t component_size(int component_type);

/// The specification's integer to float conversion of a normalised component (section 3.11): -1..1 or 0..1.
double normalised(double value, int component_type);

/// All elements as floats, normalised integers converted; sparse values applied; every value is finite.
/// `index` must be in range; `place` names what reads it and goes into the error.
std::vector<float> read_floats(const Document& document, std::size_t index, const std::string& place);

/// All elements as unsigned integers (normalisation does not apply): for indices and JOINTS. Fails on other component
/// types, except floats that hold whole numbers, which old exporters write for JOINTS.
std::vector<std::uint32_t> read_unsigned(const Document& document, std::size_t index, const std::string& place);

}  // namespace bendy::converter::gltf
