#pragma once

#include <functional>
#include <string>

namespace bendy::viewer {

/// An OpenGL 3.3 core context without a window, current on this thread while it lives. Draws into framebuffer objects
/// only.
class OffscreenContext {
public:
    /// Takes the first that works: EGL without a surface, EGL on a device, EGL on the default display. Throws
    /// ViewerError with the reason that each one gave if none works.
    OffscreenContext();
    OffscreenContext(const OffscreenContext&) = delete;
    OffscreenContext& operator=(const OffscreenContext&) = delete;
    OffscreenContext(OffscreenContext&&) = delete;
    OffscreenContext& operator=(OffscreenContext&&) = delete;
    ~OffscreenContext();

    /// Such as "EGL surfaceless: llvmpipe (LLVM 15.0.6, 256 bits), 4.5 (Core Profile) Mesa 22.3.6".
    [[nodiscard]] const std::string& description() const { return description_; }

private:
    bool try_egl(unsigned platform, const char* name, std::string& tried);

    std::function<void()> close_;
    std::string description_;
};

}  // namespace bendy::viewer
