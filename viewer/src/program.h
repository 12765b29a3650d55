#pragma once

#include <epoxy/gl.h>

namespace bendy::viewer {

/// A linked shader program.
class Program {
public:
    /// Throws ViewerError with the compiler's words; that is a bug here or in the driver.
    Program(const char* vertex_source, const char* fragment_source);
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;
    Program(Program&&) = delete;
    Program& operator=(Program&&) = delete;
    ~Program();

    void use() const { glUseProgram(name_); }
    /// Place of a uniform; -1, which OpenGL ignores, if the compiler has dropped it.
    [[nodiscard]] GLint operator[](const char* uniform) const { return glGetUniformLocation(name_, uniform); }

private:
    GLuint name_;
};

}  // namespace bendy::viewer
