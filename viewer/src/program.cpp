#include "program.h"

#include <bendy/viewer/viewer_error.h>

#include <array>
#include <string>

namespace bendy::viewer {
namespace {

constexpr GLsizei kLogLength = 2000;

GLuint compile(GLenum kind, const char* source) {
    const GLuint shader = glCreateShader(kind);
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    GLint is_good = GL_FALSE;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &is_good);
    if (is_good == GL_TRUE) return shader;
    std::array<char, kLogLength> log{};
    glGetShaderInfoLog(shader, kLogLength, nullptr, log.data());
    glDeleteShader(shader);
    throw ViewerError("a shader does not compile: " + std::string(log.data()));
}

}  // namespace

Program::Program(const char* vertex_source, const char* fragment_source) : name_(glCreateProgram()) {
    const GLuint vertex = compile(GL_VERTEX_SHADER, vertex_source);
    const GLuint fragment = compile(GL_FRAGMENT_SHADER, fragment_source);
    glAttachShader(name_, vertex);
    glAttachShader(name_, fragment);
    glLinkProgram(name_);
    glDeleteShader(vertex);
    glDeleteShader(fragment);
    GLint is_good = GL_FALSE;
    glGetProgramiv(name_, GL_LINK_STATUS, &is_good);
    if (is_good == GL_TRUE) return;
    std::array<char, kLogLength> log{};
    glGetProgramInfoLog(name_, kLogLength, nullptr, log.data());
    glDeleteProgram(name_);
    throw ViewerError("the shaders do not link: " + std::string(log.data()));
}

Program::~Program() {
    glDeleteProgram(name_);
}

}  // namespace bendy::viewer
