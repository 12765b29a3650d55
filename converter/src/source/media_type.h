#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace bendy::converter {

/// The media type that an image's first bytes show, or empty.
std::string media_type_of(std::span<const std::byte> bytes);

}  // namespace bendy::converter
