#include "gl_context.h"

#include "gl.h"

#include <bendy/viewer/viewer_error.h>

// Types and numbers only: the libraries are opened when they are needed, so that the program starts where they are
// missing.
#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/osmesa.h>
#include <dlfcn.h>

#include <array>

namespace bendy::viewer {
namespace {

/// A library that stays open: GL drivers do not survive being closed and opened again.
class Library {
public:
    explicit Library(const char* file) : handle_(dlopen(file, RTLD_NOW | RTLD_LOCAL)) {}
    [[nodiscard]] bool is_open() const { return handle_ != nullptr; }
    template <class Function>
    [[nodiscard]] Function find(const char* name) const {
        return reinterpret_cast<Function>(dlsym(handle_, name));
    }

private:
    void* handle_;
};

const Library& egl_library() {
    static const Library library("libEGL.so.1");
    return library;
}
const Library& osmesa_library() {
    static const Library library("libOSMesa.so.8");
    return library;
}

gl::AnyFunction find_egl(const char* name) {
    static const auto find = egl_library().find<decltype(&eglGetProcAddress)>("eglGetProcAddress");
    return find(name);
}
gl::AnyFunction find_osmesa(const char* name) {
    static const auto find = osmesa_library().find<decltype(&OSMesaGetProcAddress)>("OSMesaGetProcAddress");
    return find(name);
}

std::string text_of(GLenum what) {
    const GLubyte* text = gl::GetString(what);
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

EGLDisplay open_display(unsigned platform) {
    const Library& egl = egl_library();
    if (platform == kDefaultDisplay) return egl.find<decltype(&eglGetDisplay)>("eglGetDisplay")(EGL_DEFAULT_DISPLAY);
    const auto get_display = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(find_egl("eglGetPlatformDisplayEXT"));
    if (get_display == nullptr) return EGL_NO_DISPLAY;
    if (platform != EGL_PLATFORM_DEVICE_EXT) return get_display(platform, EGL_DEFAULT_DISPLAY, nullptr);
    const auto query = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(find_egl("eglQueryDevicesEXT"));
    EGLDeviceEXT device = nullptr;
    EGLint count = 0;
    if (query == nullptr || query(1, &device, &count) == EGL_FALSE || count == 0) return EGL_NO_DISPLAY;
    return get_display(platform, device, nullptr);
}

}  // namespace

OffscreenContext::OffscreenContext(ContextKind kind) {
    std::string tried;
    if (kind != ContextKind::osmesa) {
        if (!egl_library().is_open()) {
            add_line(tried, "EGL", "libEGL.so.1 is not there");
        } else if (try_egl(EGL_PLATFORM_SURFACELESS_MESA, "EGL surfaceless", tried) ||
                   try_egl(EGL_PLATFORM_DEVICE_EXT, "EGL device", tried) ||
                   try_egl(kDefaultDisplay, "EGL default display", tried)) {
            return;
        }
    }
    if (kind != ContextKind::egl && try_osmesa(tried)) return;
    throw ViewerError("no OpenGL 3.3 here: " + tried);
}

OffscreenContext::~OffscreenContext() {
    if (close_) close_();
}

bool OffscreenContext::try_egl(unsigned platform, const char* name, std::string& tried) {
    const Library& egl = egl_library();
    EGLDisplay display = open_display(platform);
    if (display == EGL_NO_DISPLAY) return add_line(tried, name, "no display"), false;
    if (egl.find<decltype(&eglInitialize)>("eglInitialize")(display, nullptr, nullptr) == EGL_FALSE)
        return add_line(tried, name, "cannot be initialised"), false;
    const auto terminate = egl.find<decltype(&eglTerminate)>("eglTerminate");
    egl.find<decltype(&eglBindAPI)>("eglBindAPI")(EGL_OPENGL_API);

    constexpr std::array<EGLint, 5> kConfig{EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint configs = 0;
    egl.find<decltype(&eglChooseConfig)>("eglChooseConfig")(display, kConfig.data(), &config, 1, &configs);
    if (configs == 0) config = nullptr;  // EGL_KHR_no_config_context, where there is none
    constexpr std::array<EGLint, 7> kContext{
        EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    EGLContext context =
        egl.find<decltype(&eglCreateContext)>("eglCreateContext")(display, config, EGL_NO_CONTEXT, kContext.data());
    if (context == EGL_NO_CONTEXT) {
        terminate(display);
        return add_line(tried, name, "no OpenGL 3.3 core context"), false;
    }
    const auto make_current = egl.find<decltype(&eglMakeCurrent)>("eglMakeCurrent");
    const auto destroy = egl.find<decltype(&eglDestroyContext)>("eglDestroyContext");
    if (make_current(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_FALSE) {
        destroy(display, context);
        terminate(display);
        return add_line(tried, name, "needs a surface"), false;
    }
    close_ = [=] {
        make_current(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        destroy(display, context);
        terminate(display);
    };
    gl::load(find_egl);
    description_ = describe(name);
    return true;
}

bool OffscreenContext::try_osmesa(std::string& tried) {
    const Library& osmesa = osmesa_library();
    if (!osmesa.is_open()) return add_line(tried, "OSMesa", "libOSMesa.so.8 is not there"), false;
    constexpr std::array<int, 11> kContext{OSMESA_FORMAT,
                                           OSMESA_RGBA,
                                           OSMESA_PROFILE,
                                           OSMESA_CORE_PROFILE,
                                           OSMESA_CONTEXT_MAJOR_VERSION,
                                           3,
                                           OSMESA_CONTEXT_MINOR_VERSION,
                                           3,
                                           OSMESA_DEPTH_BITS,
                                           24,
                                           0};
    const auto create = osmesa.find<decltype(&OSMesaCreateContextAttribs)>("OSMesaCreateContextAttribs");
    OSMesaContext context = create == nullptr ? nullptr : create(kContext.data(), nullptr);
    if (context == nullptr) return add_line(tried, "OSMesa", "no OpenGL 3.3 core context"), false;
    constexpr int kSide = 4;
    osmesa_picture_ = std::make_unique<unsigned char[]>(std::size_t{4} * kSide * kSide);
    const auto make_current = osmesa.find<decltype(&OSMesaMakeCurrent)>("OSMesaMakeCurrent");
    const auto destroy = osmesa.find<decltype(&OSMesaDestroyContext)>("OSMesaDestroyContext");
    if (make_current(context, osmesa_picture_.get(), GL_UNSIGNED_BYTE, kSide, kSide) == GL_FALSE) {
        destroy(context);
        return add_line(tried, "OSMesa", "cannot be made current"), false;
    }
    close_ = [=] { destroy(context); };
    gl::load(find_osmesa);
    description_ = describe("OSMesa");
    return true;
}

}  // namespace bendy::viewer
