#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/viewer/picture.h>

#include <cstdint>
#include <string>

namespace bendy::viewer {

struct ReadImage {
    Picture picture;
    std::string problem;  ///< why the picture is missing, otherwise empty
};

/// Decodes a PNG, JPEG, WebP, BMP or TGA image, recognised by its first bytes. A picture of more than `most_pixels`
/// pixels is a problem, which is found before memory is allocated.
ReadImage read_image(Bytes bytes, std::uint64_t most_pixels);

}  // namespace bendy::viewer
