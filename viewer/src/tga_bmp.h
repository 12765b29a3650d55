#pragma once

#include "image_reader.h"

namespace bendy::viewer {

/// Room for a picture of so many pixels, or a problem that says why there is none.
bool prepare(ReadImage& out, std::uint64_t width, std::uint64_t height, std::uint64_t most_pixels);

/// Reads a BMP or TGA file, which are usual beside X and MD2 files; false if the bytes begin like neither.
bool read_bmp_or_tga(Bytes bytes, std::uint64_t most_pixels, ReadImage& out);

}  // namespace bendy::viewer
