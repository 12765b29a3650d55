#pragma once

#include <epoxy/gl.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

// OpenGL: an offscreen context, owners of OpenGL objects, shader programs, texture units.

namespace bendy::viewer {

/// Throws ViewerError if the process may not take so much more memory, under a limit such as `ulimit -v`: drivers do
/// not survive a lack of it. \param what  what takes it, for the message
void require_memory(std::uint64_t bytes, const std::string& what);
/// The same for an OpenGL driver. Call it before the driver is loaded.
void require_driver_memory();

/// An OpenGL 3.3 core context without a window, current on this thread during its lifetime. It draws into framebuffer
/// objects only.
class OffscreenContext {
public:
    /// Uses the first of these that works: EGL without a surface, EGL on a device, EGL on the default display. If none
    /// works, throws ViewerError with the reason for each.
    OffscreenContext();
    OffscreenContext(const OffscreenContext&) = delete;
    OffscreenContext& operator=(const OffscreenContext&) = delete;
    OffscreenContext(OffscreenContext&&) = delete;
    OffscreenContext& operator=(OffscreenContext&&) = delete;
    ~OffscreenContext();

    /// For example "EGL surfaceless: llvmpipe (LLVM 15.0.6, 256 bits), 4.5 (Core Profile) Mesa 22.3.6".
    [[nodiscard]] const std::string& description() const { return description_; }

private:
    bool try_egl(unsigned platform, const char* name, std::string& tried);

    std::function<void()> close_;
    std::string description_;
};

/// Owns an OpenGL object. The context that made it must be current when it is destroyed.
template <class Make, class Drop>
class GlObject {
public:
    GlObject() { Make{}(1, &name_); }
    GlObject(GlObject&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
    GlObject& operator=(GlObject&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }
    GlObject(const GlObject&) = delete;
    GlObject& operator=(const GlObject&) = delete;
    ~GlObject() {
        if (name_ != 0) Drop{}(1, &name_);
    }
    [[nodiscard]] GLuint name() const { return name_; }

private:
    GLuint name_ = 0;
};

#define BENDY_GL_OBJECT(Type, plural)                                                         \
    struct Make##Type {                                                                       \
        void operator()(GLsizei n, GLuint* names) const { glGen##plural(n, names); }          \
    };                                                                                        \
    struct Drop##Type {                                                                       \
        void operator()(GLsizei n, const GLuint* names) const { glDelete##plural(n, names); } \
    };                                                                                        \
    using Type = GlObject<Make##Type, Drop##Type>;

BENDY_GL_OBJECT(Buffer, Buffers)
BENDY_GL_OBJECT(GlTexture, Textures)
BENDY_GL_OBJECT(VertexArray, VertexArrays)
BENDY_GL_OBJECT(Framebuffer, Framebuffers)
BENDY_GL_OBJECT(Renderbuffer, Renderbuffers)
#undef BENDY_GL_OBJECT

/// A linked shader program.
class Program {
public:
    /// Throws ViewerError with the compiler's message, which means a bug here or in the driver.
    Program(const char* vertex_source, const char* fragment_source);
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;
    Program(Program&&) = delete;
    Program& operator=(Program&&) = delete;
    ~Program();

    void use() const { glUseProgram(name_); }
    /// Returns the location of a uniform; -1, which OpenGL ignores, if the compiler removed it.
    [[nodiscard]] GLint operator[](const char* uniform) const { return glGetUniformLocation(name_, uniform); }

private:
    GLuint name_;
};

/// The use of each texture unit. OpenGL 3.3 has at least 16 each in the fragment and the vertex stage.
enum TextureUnit : GLuint {
    kMaterialUnit = 0,  ///< and the four after it: base colour, metallic-roughness, normal, occlusion, emissive
    kReflectanceUnit = 5,
    kPaletteUnit = 8,
    kInfluenceUnit = 9,
    kDisplacementUnit = 10,
    kWeightUnit = 11,
    kUploadUnit = 15,  ///< for uploads, so that they do not unbind the textures in use
};

/// Throws ViewerError if OpenGL has run out of memory since the last call.
void check_memory();

/// Binds a texture to a unit; `target` such as GL_TEXTURE_2D.
void bind_texture(GLuint unit, GLenum target, GLuint texture);

/// Describes an input of the vertex shader: floats, `offset` bytes into each vertex of `stride` bytes.
void describe_floats(GLuint place, GLint components, std::size_t stride, std::size_t offset);

}  // namespace bendy::viewer
