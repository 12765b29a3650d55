#include <bendy/viewer/picture_file.h>

#include <bendy/viewer/viewer_error.h>

#include <png.h>

#include <algorithm>
#include <string>

namespace bendy::viewer {

std::vector<std::byte> encode_png(const Picture& picture) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = picture.width;
    image.height = picture.height;
    image.format = PNG_FORMAT_RGBA;
    const bool is_opaque = [&] {
        for (std::size_t at = 3; at < picture.pixels.size(); at += 4) {
            if (picture.pixels[at] != 255) return false;
        }
        return true;
    }();
    std::vector<std::uint8_t> opaque;
    if (is_opaque) {
        image.format = PNG_FORMAT_RGB;
        opaque.reserve(picture.pixels.size() / 4 * 3);
        for (std::size_t at = 0; at + 4 <= picture.pixels.size(); at += 4)
            opaque.insert(opaque.end(), {picture.pixels[at], picture.pixels[at + 1], picture.pixels[at + 2]});
    }
    const std::vector<std::uint8_t>& pixels = is_opaque ? opaque : picture.pixels;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::vector<std::byte> bytes(size);
    if (png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels.data(), 0, nullptr) == 0)
        throw ViewerError(std::string("PNG: ") + image.message);
    bytes.resize(size);
    return bytes;
}

Picture contact_sheet(const std::vector<Picture>& pictures, std::uint32_t columns, const Picture& empty) {
    const Picture& first = pictures.front();
    const auto rows = (static_cast<std::uint32_t>(pictures.size()) + columns - 1) / columns;
    Picture sheet{columns * first.width, rows * first.height, {}};
    sheet.pixels.resize(sheet.row_size() * sheet.height);
    for (std::size_t k = 0; k < std::size_t{rows} * columns; ++k) {
        const Picture& picture = k < pictures.size() ? pictures[k] : empty;
        const std::size_t left = (k % columns) * first.row_size();
        const std::size_t top = (k / columns) * first.height;
        for (std::size_t y = 0; y < first.height; ++y) {
            const auto from = static_cast<std::ptrdiff_t>(y * first.row_size());
            const auto to = static_cast<std::ptrdiff_t>((top + y) * sheet.row_size() + left);
            std::copy_n(picture.pixels.begin() + from, first.row_size(), sheet.pixels.begin() + to);
        }
    }
    return sheet;
}

}  // namespace bendy::viewer
