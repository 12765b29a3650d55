#include "program.h"

#include <bendy/viewer/viewer_error.h>

#include <array>
#include <string>

namespace bendy::viewer {
namespace {

constexpr GLsizei kLogLength = 2000;

GLuint compile(GLenum kind, const char* source) {
    const GLuint shader = gl::CreateShader(kind);
    gl::ShaderSource(shader, 1, &source, nullptr);
    gl::CompileShader(shader);
    GLint is_good = GL_FALSE;
    gl::GetShaderiv(shader, GL_COMPILE_STATUS, &is_good);
    if (is_good == GL_TRUE) return shader;
    std::array<char, kLogLength> log{};
    gl::GetShaderInfoLog(shader, kLogLength, nullptr, log.data());
    gl::DeleteShader(shader);
    throw ViewerError("a shader does not compile: " + std::string(log.data()));
}

}  // namespace

Program::Program(const char* vertex_source, const char* fragment_source) : name_(gl::CreateProgram()) {
    const GLuint vertex = compile(GL_VERTEX_SHADER, vertex_source);
    const GLuint fragment = compile(GL_FRAGMENT_SHADER, fragment_source);
    gl::AttachShader(name_, vertex);
    gl::AttachShader(name_, fragment);
    gl::LinkProgram(name_);
    gl::DeleteShader(vertex);
    gl::DeleteShader(fragment);
    GLint is_good = GL_FALSE;
    gl::GetProgramiv(name_, GL_LINK_STATUS, &is_good);
    if (is_good == GL_TRUE) return;
    std::array<char, kLogLength> log{};
    gl::GetProgramInfoLog(name_, kLogLength, nullptr, log.data());
    gl::DeleteProgram(name_);
    throw ViewerError("the shaders do not link: " + std::string(log.data()));
}

Program::~Program() {
    gl::DeleteProgram(name_);
}

}  // namespace bendy::viewer
