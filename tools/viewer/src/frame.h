#pragma once

#include "opengl.h"

#include <bendy/viewer/picture.h>

#include <cstdint>

namespace bendy::viewer {

/// A render target: sRGB colour and depth with several samples per pixel, and the picture resolved from them.
class Frame {
public:
    /// Throws ViewerError if the driver cannot make it. With `samples` 1 pixels are not antialiased; with `srgb` false
    /// numbers are stored as they are.
    Frame(std::uint32_t width, std::uint32_t height, std::uint32_t samples = 4, bool srgb = true);

    /// Makes it the current render target.
    void bind() const;
    /// Returns the picture so far. `is_transparent`: the background is transparent, so colours are premultiplied.
    [[nodiscard]] Picture read(bool is_transparent) const;
    /// Copies it into the current window's own framebuffer.
    void copy_to_window() const;
    /// Returns the back buffer of the current window, which must have this size.
    [[nodiscard]] Picture read_window() const;

    [[nodiscard]] std::uint32_t width() const { return width_; }
    [[nodiscard]] std::uint32_t height() const { return height_; }

private:
    void resolve() const;
    [[nodiscard]] Picture read_pixels() const;

    std::uint32_t width_;
    std::uint32_t height_;
    Framebuffer samples_;
    Framebuffer picture_;
    Renderbuffer sample_colour_;
    Renderbuffer sample_depth_;
    Renderbuffer picture_colour_;
};

}  // namespace bendy::viewer
