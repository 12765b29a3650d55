#pragma once

#include "document.h"

#include <cstddef>
#include <span>
#include <vector>

namespace bendy::converter::gltf {

// The filters of KHR_meshopt_compression (appendix B), in place. Computed in double with the specification's formulas,
// so that every machine decodes the same bytes; libraries differ in the last digit between instruction sets. `bytes`
// holds whole elements.

/// Decodes elements of four 8-bit (stride 4) or 16-bit (stride 8) components to unit vectors: octahedral x, y, the
/// scale, and one that is passed through.
void decode_octahedral(std::span<std::byte> bytes, std::size_t stride);

/// Decodes elements of four 16-bit components to unit quaternions: the three smaller components, and which one is
/// omitted.
void decode_quaternion(std::span<std::byte> bytes);

/// Decodes 32-bit words of an 8-bit exponent and a 24-bit mantissa to floats.
void decode_exponential(std::span<std::byte> bytes);

/// Decodes elements of four 8-bit (stride 4) or 16-bit (stride 8) components to RGBA: luma, two chroma, alpha with the
/// scale.
void decode_colour(std::span<std::byte> bytes, std::size_t stride);

/// Decodes the attribute bit-stream of KHR_meshopt_compression (appendix A, mode 0) into out, which has room for count
/// elements of stride bytes; stride is a multiple of 4, at most 256. Supports both versions: 0 is that of
/// EXT_meshopt_compression; current distributions' meshoptimizer does not support 1. False: the stream is malformed.
[[nodiscard]] bool decode_meshopt_vertices(std::span<const std::byte> stream, std::size_t stride,
                                           std::span<std::byte> out);

/// Decodes a view of EXT_meshopt_compression or KHR_meshopt_compression to `count * stride` bytes and applies its
/// filter. Fails at the view's place.
std::vector<std::byte> decode_meshopt(const CompressedView& view, std::span<const std::byte> source, Budget& budget);

}  // namespace bendy::converter::gltf
