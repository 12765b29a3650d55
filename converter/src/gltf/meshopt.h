#pragma once

#include "document.h"

#include <cstddef>
#include <span>
#include <vector>

namespace bendy::converter::gltf {

// The filters of KHR_meshopt_compression (appendix B), in place. Computed in double with the specification's formulas,
// so that every machine decodes to the same bytes; libraries differ in the last place between instruction sets. `bytes`
// holds whole elements.

/// Elements of four 8-bit (stride 4) or 16-bit (stride 8) components: octahedral x, y, the scale, and one passed
/// through, to a unit vector.
void decode_octahedral(std::span<std::byte> bytes, std::size_t stride);

/// Elements of four 16-bit components: the three smaller of a unit quaternion and which one is left out.
void decode_quaternion(std::span<std::byte> bytes);

/// 32-bit words of an 8-bit exponent over a 24-bit mantissa, to floats.
void decode_exponential(std::span<std::byte> bytes);

/// Elements of four 8-bit (stride 4) or 16-bit (stride 8) components: luma, two of chroma, alpha with the scale, to
/// RGBA.
void decode_colour(std::span<std::byte> bytes, std::size_t stride);

/// Decodes the attribute bit-stream of KHR_meshopt_compression (appendix A, mode 0) into out, which has room for count
/// elements of stride bytes; stride is a multiple of 4, at most 256. Both versions: 0 is that of
/// EXT_meshopt_compression, 1 is unknown to the meshoptimizer releases of today's distributions. False: the stream is
/// malformed.
[[nodiscard]] bool decode_meshopt_vertices(std::span<const std::byte> stream, std::size_t stride,
                                           std::span<std::byte> out);

/// Decodes a view of EXT_meshopt_compression or KHR_meshopt_compression: `count * stride` bytes, filter applied.
/// Fails at the view's place.
std::vector<std::byte> decode_meshopt(const CompressedView& view, std::span<const std::byte> source, Budget& budget);

}  // namespace bendy::converter::gltf
