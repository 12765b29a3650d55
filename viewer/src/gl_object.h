#pragma once

#include <epoxy/gl.h>
#include <utility>

namespace bendy::viewer {

/// Owns the number of an OpenGL object; the context that made it must be current when it goes.
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

}  // namespace bendy::viewer
