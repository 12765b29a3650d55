#pragma once

#include "opengl.h"

#include <bendy/viewer/picture.h>

#include <cstdint>

namespace bendy::viewer {

/// What is drawn into: sRGB colour and depth with several samples a pixel, and the picture that they make.
class Frame {
public:
    /// Throws ViewerError if the driver has not enough memory for it. `samples` 1: each pixel is what was drawn there;
    /// and `srgb` false: its numbers too.
    Frame(std::uint32_t width, std::uint32_t height, std::uint32_t samples = 4, bool srgb = true);

    /// Makes it the place where everything is drawn.
    void bind() const;
    /// The picture so far. `is_transparent`: it was drawn over nothing, so that its colours hold their alpha.
    [[nodiscard]] Picture read(bool is_transparent) const;
    /// Copies it into the current window's own framebuffer.
    void copy_to_window() const;
    /// What stands in the current window, not yet shown; it must be of this size.
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
