#include "frame.h"

#include <algorithm>
#include <cmath>

namespace bendy::viewer {
namespace {

void attach(const Renderbuffer& buffer, GLenum place, GLenum format, std::uint32_t width, std::uint32_t height,
            std::uint32_t samples) {
    glBindRenderbuffer(GL_RENDERBUFFER, buffer.name());
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples > 1 ? static_cast<GLsizei>(samples) : 0, format,
                                     static_cast<GLsizei>(width), static_cast<GLsizei>(height));
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, place, GL_RENDERBUFFER, buffer.name());
}

void check_complete() {
    check_memory();
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw ViewerError("the graphics driver cannot make a picture of this size");
}

float to_linear(float srgb) {
    return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}
float to_srgb(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

/// Colours drawn over transparent black are premultiplied; this undoes it.
void divide_by_alpha(Picture& picture) {
    for (std::size_t at = 0; at + 4 <= picture.pixels.size(); at += 4) {
        const std::uint8_t alpha = picture.pixels[at + 3];
        if (alpha == 0 || alpha == 255) continue;
        for (std::size_t c = at; c < at + 3; ++c) {
            const float linear =
                to_linear(static_cast<float>(picture.pixels[c]) / 255.0f) * 255.0f / static_cast<float>(alpha);
            picture.pixels[c] = static_cast<std::uint8_t>(std::lround(255.0f * to_srgb(std::min(linear, 1.0f))));
        }
    }
}

}  // namespace

Frame::Frame(std::uint32_t width, std::uint32_t height, std::uint32_t samples, bool srgb)
    : width_(width), height_(height) {
    GLint most = 1;
    GLint largest = 0;
    glGetIntegerv(GL_MAX_SAMPLES, &most);
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
    if (std::max(width, height) > static_cast<std::uint32_t>(largest))
        throw ViewerError("the graphics driver makes pictures up to " + std::to_string(largest) + " pixels wide");
    constexpr std::uint64_t kBytesOfASample = 8;  // colour, depth
    constexpr std::uint64_t kBytesOfAPixel = 8;   // colour, and a copy of it
    require_memory((samples * kBytesOfASample + kBytesOfAPixel) * width * height, "a picture of this size");
    const std::uint32_t used = std::min(samples, static_cast<std::uint32_t>(std::max(most, 1)));
    const GLenum format = srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8;
    glBindFramebuffer(GL_FRAMEBUFFER, picture_.name());
    attach(picture_colour_, GL_COLOR_ATTACHMENT0, format, width, height, 1);
    check_complete();
    glBindFramebuffer(GL_FRAMEBUFFER, samples_.name());
    attach(sample_colour_, GL_COLOR_ATTACHMENT0, format, width, height, used);
    attach(sample_depth_, GL_DEPTH_ATTACHMENT, GL_DEPTH_COMPONENT24, width, height, used);
    check_complete();
}

void Frame::bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, samples_.name());
    glViewport(0, 0, static_cast<GLsizei>(width_), static_cast<GLsizei>(height_));
    glEnable(GL_FRAMEBUFFER_SRGB);
}

void Frame::resolve() const {
    const auto w = static_cast<GLint>(width_);
    const auto h = static_cast<GLint>(height_);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, samples_.name());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, picture_.name());
    glBlitFramebuffer(0, 0, w, h, 0, 0, w, h, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

Picture Frame::read(bool is_transparent) const {
    resolve();
    glBindFramebuffer(GL_READ_FRAMEBUFFER, picture_.name());
    Picture picture = read_pixels();
    if (is_transparent) divide_by_alpha(picture);
    return picture;
}

Picture Frame::read_window() const {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    Picture picture = read_pixels();
    for (std::size_t at = 3; at < picture.pixels.size(); at += 4) picture.pixels[at] = 255;
    return picture;
}

Picture Frame::read_pixels() const {
    Picture picture{width_, height_, std::vector<std::uint8_t>(std::size_t{4} * width_ * height_)};
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, static_cast<GLsizei>(width_), static_cast<GLsizei>(height_), GL_RGBA, GL_UNSIGNED_BYTE,
                 picture.pixels.data());
    // OpenGL has the bottom row first.
    const auto row = [&](std::uint32_t y) {
        return picture.pixels.begin() + static_cast<std::ptrdiff_t>(picture.row_size() * y);
    };
    for (std::uint32_t y = 0; y < height_ / 2; ++y) std::swap_ranges(row(y), row(y + 1), row(height_ - 1 - y));
    return picture;
}

void Frame::copy_to_window() const {
    resolve();
    const auto w = static_cast<GLint>(width_);
    const auto h = static_cast<GLint>(height_);
    glDisable(GL_FRAMEBUFFER_SRGB);  // the colours are already encoded
    glBindFramebuffer(GL_READ_FRAMEBUFFER, picture_.name());
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glBlitFramebuffer(0, 0, w, h, 0, 0, w, h, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

}  // namespace bendy::viewer
