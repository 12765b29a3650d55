#pragma once

#include <cstddef>
#include <span>

namespace bendy::converter::gltf {

/// Decodes the attribute bit-stream of KHR_meshopt_compression (appendix A, mode 0) into out, which has room for count
/// elements of stride bytes; stride is a multiple of 4, at most 256. Both versions: 0 is that of
/// EXT_meshopt_compression, 1 is unknown to the meshoptimizer releases of today's distributions. False: the stream is
/// malformed.
[[nodiscard]] bool decode_meshopt_vertices(std::span<const std::byte> stream, std::size_t stride,
                                           std::span<std::byte> out);

}  // namespace bendy::converter::gltf
