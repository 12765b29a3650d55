#pragma once

#include <bendy/converter/scene.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace bendy::converter {

/// A known image format, recognised by its first bytes.
struct ImageKind {
    std::string_view media_type;  ///< empty: it has none
    std::string_view suffix;      ///< of a file's name, with the dot
};

/// The usual suffix of each format, followed by other suffixes in use.
std::span<const ImageKind> image_kinds();

/// The media type according to an image's first bytes, or empty.
std::string media_type_of(std::span<const std::byte> bytes);

/// TGA files have no signature: true if the header could be one of theirs.
bool may_be_tga(std::span<const std::byte> bytes);

/// Whether bytes begin like a known image format.
bool is_image(std::span<const std::byte> bytes);

/// The longer side of a PNG or JPEG image in pixels; nothing if it cannot be determined.
std::optional<std::uint32_t> longer_side(const Image& image);

}  // namespace bendy::converter
