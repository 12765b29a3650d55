#pragma once

#include <bendy/converter/scene.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace bendy::converter {

/// A kind of image that is known here, by its first bytes.
struct ImageKind {
    std::string_view media_type;  ///< empty: it has none
    std::string_view suffix;      ///< of a file's name, with the dot
};

/// The usual suffix of each kind, and after these the others that are met.
std::span<const ImageKind> image_kinds();

/// The media type that an image's first bytes show, or empty.
std::string media_type_of(std::span<const std::byte> bytes);

/// TGA files have no sign of their own at their beginning: a header that can be one of theirs.
bool may_be_tga(std::span<const std::byte> bytes);

/// Whether bytes begin as an image does, of a kind that is known here.
bool is_image(std::span<const std::byte> bytes);

/// The longer side of a PNG or JPEG image in pixels; nothing if its bytes do not say.
std::optional<std::uint32_t> longer_side(const Image& image);

}  // namespace bendy::converter
