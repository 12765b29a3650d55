#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/viewer/picture.h>

#include <cstdint>
#include <string>

namespace bendy::viewer {

/// What an image says of itself in its first bytes.
struct ImageSize {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::string problem;  ///< why it cannot be read, otherwise empty
};

struct ReadImage {
    Picture picture;
    std::string problem;  ///< why the picture is missing, otherwise empty
};

/// What texels are, which says how they are averaged.
enum class Texels : std::uint8_t { srgb, linear };

/// Returns the side of an image that is halved so many times, as OpenGL does for mipmaps, but rounded up.
inline std::uint32_t halved(std::uint32_t side, unsigned halvings) {
    return (side >> halvings) + ((side & ((1u << halvings) - 1u)) != 0 ? 1u : 0u);
}

/// Returns the size of a PNG, JPEG, WebP, BMP or TGA image, recognised by its first bytes. An image that would take too
/// much memory or time to decode is a problem: a side of more than 16,384 pixels; more than 8,192 x 8,192 pixels, if
/// the format needs all of them in memory at once, which only PNG (unless interlaced) and lossy WebP do not; or more
/// than a million pixels of which the bytes cannot hold the most.
ImageSize read_image_size(Bytes bytes);

/// Decodes such an image, with its sides halved up to 14 times. The memory that it takes is that of the result if the
/// format allows: PNG is read row by row, JPEG and lossy WebP are scaled while they are decoded. Throws std::bad_alloc.
ReadImage read_image(Bytes bytes, unsigned halvings = 0, Texels texels = Texels::srgb);

}  // namespace bendy::viewer
