#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <vector>

// Pictures, and the bytes of image files. Everything here throws ViewerError when the library refuses.

namespace bendy::viewer {

/// No picture can be made: no OpenGL, no display, not enough memory. what() is a line for the user.
class ViewerError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Pixels from the top left, row after row: red, green, blue, alpha; sRGB, alpha straight.
struct Picture {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::uint8_t> pixels;  ///< 4 * width * height

    [[nodiscard]] std::size_t row_size() const { return std::size_t{4} * width; }
};

std::vector<std::byte> encode_png(const Picture& picture);

/// A picture after another, all of one size, as an animation that repeats for ever.
class AnimationFile {
public:
    AnimationFile() = default;
    AnimationFile(const AnimationFile&) = delete;
    AnimationFile& operator=(const AnimationFile&) = delete;
    AnimationFile(AnimationFile&&) = delete;
    AnimationFile& operator=(AnimationFile&&) = delete;
    virtual ~AnimationFile() = default;
    /// \param seconds  when it is to be seen, from the start; ascending
    virtual void add(const Picture& picture, double seconds) = 0;
    /// \param seconds  the whole length
    virtual std::vector<std::byte> finish(double seconds) = 0;
};

/// 256 colours a picture, hundredths of a second; a pixel is there or is not.
std::unique_ptr<AnimationFile> make_gif(std::uint32_t width, std::uint32_t height);
std::unique_ptr<AnimationFile> make_webp(std::uint32_t width, std::uint32_t height);

/// Pictures of one size as one, in rows of `columns`. `empty`, of the same size, fills the last row.
Picture contact_sheet(const std::vector<Picture>& pictures, std::uint32_t columns, const Picture& empty);

}  // namespace bendy::viewer
