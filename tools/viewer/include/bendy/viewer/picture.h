#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <vector>

// Pictures, and their encoding as image files. All functions throw ViewerError if encoding fails.
namespace bendy::viewer {

/// Thrown if no picture can be made: no OpenGL, no display, too little memory. what() is a line for the user.
class ViewerError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Rows of pixels from the top left: red, green, blue, alpha; sRGB, alpha not premultiplied.
struct Picture {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::uint8_t> pixels;  ///< 4 * width * height

    [[nodiscard]] std::size_t row_size() const { return std::size_t{4} * width; }
};

std::vector<std::byte> encode_png(const Picture& picture);

/// Encodes pictures of one size as an animation that repeats for ever.
class AnimationFile {
public:
    AnimationFile() = default;
    AnimationFile(const AnimationFile&) = delete;
    AnimationFile& operator=(const AnimationFile&) = delete;
    AnimationFile(AnimationFile&&) = delete;
    AnimationFile& operator=(AnimationFile&&) = delete;
    virtual ~AnimationFile() = default;
    /// \param seconds  when it appears, counted from the start; ascending
    virtual void add(const Picture& picture, double seconds) = 0;
    /// \param seconds  the length of the animation
    virtual std::vector<std::byte> finish(double seconds) = 0;
};

/// GIF: 256 colours per picture, times in hundredths of a second, and pixels that are either opaque or transparent.
std::unique_ptr<AnimationFile> make_gif(std::uint32_t width, std::uint32_t height);
std::unique_ptr<AnimationFile> make_webp(std::uint32_t width, std::uint32_t height);

/// Arranges pictures of one size in rows of `columns`. `empty`, of the same size, fills the last row.
Picture contact_sheet(const std::vector<Picture>& pictures, std::uint32_t columns, const Picture& empty);

}  // namespace bendy::viewer
