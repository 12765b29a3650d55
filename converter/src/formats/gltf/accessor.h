#pragma once

#include "document.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace bendy::converter::gltf {

/// Limit on the elements of an accessor without stored data: zeros that no sparse value replaces. A file that has more
/// bytes than this may have as many of them as bytes.
inline constexpr std::uint64_t kMaxImpliedElements = std::uint64_t{1} << 18;

/// Components of one element: SCALAR 1 to MAT4 16.
std::size_t component_count(const tinygltf::Accessor& accessor);

/// Bytes per component of this glTF type code.
std::size_t component_size(int component_type);

/// Converts a normalised integer component to float as the specification defines (section 3.11): -1..1 or 0..1.
double normalised(double value, int component_type);

/// All elements as floats: normalised integers converted, sparse values applied, every value finite. `index` must be in
/// range; `place` names the reader in errors.
std::vector<float> read_floats(const Document& document, std::size_t index, const std::string& place);

/// The same, with 0 for NaN, which exporters write where they divide by the length of a vector or by a sum that is
/// zero. Warns of it.
std::vector<float> read_floats_or_zero(const Document& document, std::size_t index, const std::string& place);

/// All elements as unsigned integers (never normalised), for indices and JOINTS. Fails on other component types, except
/// floats with whole values, which old exporters write for JOINTS.
std::vector<std::uint32_t> read_unsigned(const Document& document, std::size_t index, const std::string& place);

}  // namespace bendy::converter::gltf
