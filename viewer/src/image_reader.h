#pragma once

#include <bendy/format/byte_reader.h>
#include <bendy/viewer/picture.h>

#include <cstdint>
#include <string>

namespace bendy::viewer {

struct ReadImage {
    Picture picture;
    std::string problem;  ///< why there is no picture; empty if there is one
};

/// Decodes a PNG, JPEG, WebP, BMP or TGA image, told by its first bytes. Whatever the bytes hold, it gives a picture of
/// at most `most_pixels` or says why not, before it allocates.
ReadImage read_image(Bytes bytes, std::uint64_t most_pixels);

}  // namespace bendy::viewer
