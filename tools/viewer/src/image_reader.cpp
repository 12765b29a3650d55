#include "image_reader.h"

#include <png.h>
#include <turbojpeg.h>
#include <webp/decode.h>

#include <algorithm>
#include <array>
#include <climits>
#include <cstdlib>
#include <cstring>
#include <memory>

// Two formats only. Memory is zeroed, so the missing pixels of a truncated file are black.
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#define STBI_NO_STDIO
#define STBI_MALLOC(size) std::calloc(1, size)
#define STBI_REALLOC(memory, size) std::realloc(memory, size)
#define STBI_FREE(memory) std::free(memory)
#include <stb/stb_image.h>

namespace bendy::viewer {
namespace {

constexpr std::uint32_t kMostSide = 16'384;

/// Allocates the picture, or sets the problem and returns false if it is too large.
bool prepare(ReadImage& out, std::uint64_t width, std::uint64_t height, std::uint64_t most_pixels) {
    if (width == 0 || height == 0 || width > kMostSide || height > kMostSide || width > most_pixels / height) {
        out.problem = "is too large: " + std::to_string(width) + " x " + std::to_string(height);
        return false;
    }
    out.picture.width = static_cast<std::uint32_t>(width);
    out.picture.height = static_cast<std::uint32_t>(height);
    out.picture.pixels.resize(out.picture.row_size() * height);
    return true;
}

void read_png(Bytes bytes, std::uint64_t most_pixels, ReadImage& out) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    const auto free_image = [](png_image* used) { png_image_free(used); };
    const std::unique_ptr<png_image, decltype(free_image)> owner(&image, free_image);
    if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0) {
        out.problem = std::string("is not a valid PNG: ") + image.message;
        return;
    }
    if (!prepare(out, image.width, image.height, most_pixels)) return;
    image.format = PNG_FORMAT_RGBA;
    if (png_image_finish_read(&image, nullptr, out.picture.pixels.data(), 0, nullptr) == 0)
        out.problem = std::string("is not a valid PNG: ") + image.message;
}

void read_jpeg(Bytes bytes, std::uint64_t most_pixels, ReadImage& out) {
    const auto destroy = [](void* decoder) { tjDestroy(decoder); };
    const std::unique_ptr<void, decltype(destroy)> decoder(tjInitDecompress(), destroy);
    const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
    const auto size = static_cast<unsigned long>(bytes.size());
    int width = 0;
    int height = 0;
    int subsampling = 0;
    int space = 0;
    if (tjDecompressHeader3(decoder.get(), data, size, &width, &height, &subsampling, &space) != 0 || width <= 0 ||
        height <= 0) {
        out.problem = std::string("is not a valid JPEG: ") + tjGetErrorStr2(decoder.get());
        return;
    }
    if (!prepare(out, static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height), most_pixels)) return;
    // A damaged file is shown as far as possible. Scans are limited, because progressive files can have any number.
    const int failed = tjDecompress2(decoder.get(), data, size, out.picture.pixels.data(), width, 0, height, TJPF_RGBA,
                                     TJFLAG_LIMITSCANS);
    if (failed != 0 && tjGetErrorCode(decoder.get()) == TJERR_FATAL)
        out.problem = std::string("is not a valid JPEG: ") + tjGetErrorStr2(decoder.get());
}

void read_webp(Bytes bytes, std::uint64_t most_pixels, ReadImage& out) {
    const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
    int width = 0;
    int height = 0;
    if (WebPGetInfo(data, bytes.size(), &width, &height) == 0) {
        out.problem = "is not a valid WebP";
        return;
    }
    if (!prepare(out, static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height), most_pixels)) return;
    Picture& picture = out.picture;
    if (WebPDecodeRGBAInto(data, bytes.size(), picture.pixels.data(), picture.pixels.size(),
                           static_cast<int>(picture.row_size())) == nullptr)
        out.problem = "is not a valid WebP";
}

/// Reads a BMP or TGA file, the usual textures of X and MD2 files; returns false if the bytes are neither.
bool read_bmp_or_tga(Bytes bytes, std::uint64_t most_pixels, ReadImage& out) {
    if (bytes.size() > INT_MAX) return false;
    const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const auto size = static_cast<int>(bytes.size());
    const bool is_bmp = size >= 2 && std::memcmp(data, "BM", 2) == 0;
    const std::string format = is_bmp ? "BMP" : "TGA";
    int width = 0;
    int height = 0;
    int channels = 0;
    if (stbi_info_from_memory(data, size, &width, &height, &channels) == 0) {
        if (is_bmp) out.problem = "is not a valid BMP: " + std::string(stbi_failure_reason());
        return is_bmp;  // TGA has no signature, so bytes that are not a TGA header are not reported as a bad TGA
    }
    const auto w = static_cast<std::uint64_t>(std::abs(static_cast<long long>(width)));
    const auto h = static_cast<std::uint64_t>(std::abs(static_cast<long long>(height)));
    if (!prepare(out, w, h, most_pixels)) return true;
    const auto drop = [](stbi_uc* pixels) { stbi_image_free(pixels); };
    const std::unique_ptr<stbi_uc, decltype(drop)> pixels(
        stbi_load_from_memory(data, size, &width, &height, &channels, STBI_rgb_alpha), drop);
    if (!pixels || static_cast<std::uint64_t>(width) != w || static_cast<std::uint64_t>(height) != h) {
        out.problem = "is not a valid " + format + ": " + (pixels ? "bad size" : stbi_failure_reason());
        return true;
    }
    std::memcpy(out.picture.pixels.data(), pixels.get(), out.picture.pixels.size());
    return true;
}

template <std::size_t N>
bool begins(Bytes bytes, const std::array<unsigned char, N>& start, std::size_t at = 0) {
    return bytes.size() >= at && N <= bytes.size() - at &&
           std::equal(start.begin(), start.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at),
                      [](unsigned char a, std::byte b) { return a == std::to_integer<unsigned char>(b); });
}

}  // namespace

ReadImage read_image(Bytes bytes, std::uint64_t most_pixels) {
    constexpr std::array<unsigned char, 4> kPng{0x89, 'P', 'N', 'G'};
    constexpr std::array<unsigned char, 3> kJpeg{0xff, 0xd8, 0xff};
    constexpr std::array<unsigned char, 4> kWebp{'W', 'E', 'B', 'P'};
    ReadImage out;
    if (begins(bytes, kPng)) {
        read_png(bytes, most_pixels, out);
    } else if (begins(bytes, kJpeg)) {
        read_jpeg(bytes, most_pixels, out);
    } else if (begins(bytes, kWebp, 8)) {
        read_webp(bytes, most_pixels, out);
    } else if (!read_bmp_or_tga(bytes, most_pixels, out)) {
        out.problem = "is neither PNG, JPEG, WebP, BMP nor TGA";
    }
    if (!out.problem.empty()) out.picture = {};
    return out;
}

}  // namespace bendy::viewer
