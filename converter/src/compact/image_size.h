#pragma once

#include <bendy/converter/scene.h>

#include <cstdint>
#include <optional>

namespace bendy::converter {

/// The longer side of a PNG or JPEG image in pixels; nothing if its bytes do not say.
std::optional<std::uint32_t> longer_side(const Image& image);

}  // namespace bendy::converter
