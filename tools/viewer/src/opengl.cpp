#include "opengl.h"

#include <bendy/viewer/picture.h>

// libepoxy opens libEGL and libGL when the first of their functions is called, so the program starts without them. It
// aborts if they are missing, so this file looks for them first.
#define EGL_NO_X11
#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <sys/mman.h>

#include <array>
#include <thread>

namespace bendy::viewer {
namespace {

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20u;

/// Returns true if the process may map so much more, of which nothing is used.
bool can_map(std::uint64_t bytes, int protection) {
    void* const memory = mmap(nullptr, bytes, protection, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (memory == MAP_FAILED) return false;
    munmap(memory, bytes);
    return true;
}

bool has_library(const char* file) {
    return dlopen(file, RTLD_LAZY | RTLD_LOCAL) != nullptr;  // never closed: drivers crash if they are loaded again
}

std::string text_of(GLenum what) {
    const GLubyte* text = glGetString(what);
    return text == nullptr ? "?" : reinterpret_cast<const char*>(text);
}

std::string describe(const char* name) {
    return std::string(name) + ": " + text_of(GL_RENDERER) + ", " + text_of(GL_VERSION);
}

void add_line(std::string& tried, const char* name, const char* what) {
    tried += tried.empty() ? "" : "; ";
    tried += std::string(name) + ": " + what;
}

constexpr unsigned kDefaultDisplay = 0;

bool has_client_extension(const char* name) {
    return epoxy_has_egl_extension(EGL_NO_DISPLAY, name);
}

EGLDisplay open_display(unsigned platform) {
    if (platform == kDefaultDisplay) return eglGetDisplay(EGL_DEFAULT_DISPLAY);
    if (!has_client_extension("EGL_EXT_platform_base")) return EGL_NO_DISPLAY;
    if (platform != EGL_PLATFORM_DEVICE_EXT) return eglGetPlatformDisplayEXT(platform, EGL_DEFAULT_DISPLAY, nullptr);
    if (!has_client_extension("EGL_EXT_device_enumeration") && !has_client_extension("EGL_EXT_device_base"))
        return EGL_NO_DISPLAY;
    EGLDeviceEXT device = nullptr;
    EGLint count = 0;
    if (eglQueryDevicesEXT(1, &device, &count) == EGL_FALSE || count == 0) return EGL_NO_DISPLAY;
    return eglGetPlatformDisplayEXT(platform, device, nullptr);
}

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

void require_memory(std::uint64_t bytes, const std::string& what) {
    constexpr std::uint64_t kForTheDriver = 64 * kMiB;  // which compiles shaders when it draws
    if (can_map(bytes + kForTheDriver, PROT_READ | PROT_WRITE)) return;
    throw ViewerError("not enough memory for " + what + ", which takes " + std::to_string((bytes + kMiB - 1) / kMiB) +
                      " MiB");
}

void require_driver_memory() {
    // Mesa's software renderer on two processors, measured: 640 MiB of addresses, most of them libraries, and 90 MiB of
    // data.
    constexpr std::uint64_t kData = 128 * kMiB;
    const std::uint64_t addresses = (768 + 16 * std::uint64_t{std::thread::hardware_concurrency()}) * kMiB;
    if (!can_map(addresses, PROT_NONE)) {
        throw ViewerError("not enough memory for OpenGL, whose driver takes up to " + std::to_string(addresses / kMiB) +
                          " MiB of addresses (ulimit -v)");
    }
    require_memory(kData, "OpenGL");
}

OffscreenContext::OffscreenContext() {
    require_driver_memory();
    std::string tried;
    if (!epoxy_has_egl()) {
        add_line(tried, "EGL", "libEGL.so.1 is not there");
    } else if (!has_library("libGL.so.1") && !has_library("libOpenGL.so.0")) {
        add_line(tried, "OpenGL", "neither libGL.so.1 nor libOpenGL.so.0 is there");
    } else if (try_egl(EGL_PLATFORM_SURFACELESS_MESA, "EGL surfaceless", tried) ||
               try_egl(EGL_PLATFORM_DEVICE_EXT, "EGL device", tried) ||
               try_egl(kDefaultDisplay, "EGL default display", tried)) {
        return;
    }
    throw ViewerError("no OpenGL 3.3 here: " + tried);
}

OffscreenContext::~OffscreenContext() {
    if (close_) close_();
}

bool OffscreenContext::try_egl(unsigned platform, const char* name, std::string& tried) {
    EGLDisplay display = open_display(platform);
    if (display == EGL_NO_DISPLAY) return add_line(tried, name, "no display"), false;
    if (eglInitialize(display, nullptr, nullptr) == EGL_FALSE)
        return add_line(tried, name, "cannot be initialised"), false;
    eglBindAPI(EGL_OPENGL_API);

    constexpr std::array<EGLint, 5> kConfig{EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint configs = 0;
    eglChooseConfig(display, kConfig.data(), &config, 1, &configs);
    if (configs == 0) config = nullptr;  // requires EGL_KHR_no_config_context
    constexpr std::array<EGLint, 7> kContext{
        EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, kContext.data());
    if (context == EGL_NO_CONTEXT) {
        eglTerminate(display);
        return add_line(tried, name, "no OpenGL 3.3 core context"), false;
    }
    if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_FALSE) {
        eglDestroyContext(display, context);
        eglTerminate(display);
        return add_line(tried, name, "needs a surface"), false;
    }
    close_ = [=] {
        eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(display, context);
        eglTerminate(display);
    };
    description_ = describe(name);
    return true;
}

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

void check_memory() {
    while (const GLenum error = glGetError()) {
        if (error == GL_OUT_OF_MEMORY) throw ViewerError("not enough memory for OpenGL");
    }
}

void bind_texture(GLuint unit, GLenum target, GLuint texture) {
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(target, texture);
}

void describe_floats(GLuint place, GLint components, std::size_t stride, std::size_t offset) {
    glEnableVertexAttribArray(place);
    // NOLINTNEXTLINE(performance-no-int-to-ptr): as OpenGL wants it
    const auto* first = reinterpret_cast<const void*>(offset);
    glVertexAttribPointer(place, components, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride), first);
}

}  // namespace bendy::viewer
