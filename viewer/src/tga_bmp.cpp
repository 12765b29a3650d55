#include "tga_bmp.h"

#include <climits>
#include <cstdlib>
#include <cstring>
#include <memory>

// Two formats only. Pixels that a short file lacks are black: never what was in the memory before.
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
        if (is_bmp) out.problem = "is no good BMP: " + std::string(stbi_failure_reason());
        return is_bmp;  // a TGA file has no sign of its own: what is no header of one is not called a bad TGA
    }
    const auto w = static_cast<std::uint64_t>(std::abs(static_cast<long long>(width)));
    const auto h = static_cast<std::uint64_t>(std::abs(static_cast<long long>(height)));
    if (!prepare(out, w, h, most_pixels)) return true;
    const auto drop = [](stbi_uc* pixels) { stbi_image_free(pixels); };
    const std::unique_ptr<stbi_uc, decltype(drop)> pixels(
        stbi_load_from_memory(data, size, &width, &height, &channels, STBI_rgb_alpha), drop);
    if (!pixels || static_cast<std::uint64_t>(width) != w || static_cast<std::uint64_t>(height) != h) {
        out.problem = "is no good " + format + ": " + (pixels ? "bad size" : stbi_failure_reason());
        return true;
    }
    std::memcpy(out.picture.pixels.data(), pixels.get(), out.picture.pixels.size());
    return true;
}

}  // namespace bendy::viewer
