#pragma once

#include "buffers.h"

#include <cstddef>
#include <span>
#include <vector>

namespace bendy::converter::gltf {

/// Decodes a view of EXT_meshopt_compression or KHR_meshopt_compression: `count * stride` bytes, filter applied.
/// Fails at the view's place.
std::vector<std::byte> decode_meshopt(const CompressedView& view, std::span<const std::byte> source, Budget& budget);

}  // namespace bendy::converter::gltf
