#include "gl/context.h"

#include <dlfcn.h>
#include <epoxy/egl.h>

#include <array>
#include <atomic>
#include <string_view>
#include <utility>

#include "gl/api.h"

namespace lw::gl {

namespace {

const char* const kMend = "install a driver with OpenGL 4.5 (Debian: libegl1 libgl1-mesa-dri)";

// Software contexts alive on each of the two displays that Mesa can open without a window system. An EGL display is
// shared by the whole process, and so is the count of who queues on it.
enum Platform : std::size_t { kSurfaceless, kDevice, kPlatformCount };
std::array<std::atomic<int>, kPlatformCount> software_contexts{};

// libepoxy ends the process when it cannot open these.
bool libraries_exist() {
    const auto opens = [](const char* name) { return dlopen(name, RTLD_LAZY | RTLD_LOCAL) != nullptr; };
    return opens("libEGL.so.1") && (opens("libOpenGL.so.0") || opens("libGL.so.1"));
}

bool has_extension(EGLDisplay display, std::string_view name) {
    const char* list = eglQueryString(display, EGL_EXTENSIONS);
    return list != nullptr && (" " + std::string{list} + " ").find(" " + std::string{name} + " ") != std::string::npos;
}

EGLDisplay open_display(Platform platform) {
    if (!has_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_base")) return EGL_NO_DISPLAY;
    EGLDisplay display = EGL_NO_DISPLAY;
    if (platform == kSurfaceless) {
        if (!has_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) return EGL_NO_DISPLAY;
        display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    } else {
        if (!has_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device") ||
            !has_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration")) {
            return EGL_NO_DISPLAY;
        }
        EGLDeviceEXT device = nullptr;
        EGLint count = 0;
        if (!eglQueryDevicesEXT(1, &device, &count) || count < 1) return EGL_NO_DISPLAY;
        display = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, nullptr);
    }
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr)) return EGL_NO_DISPLAY;
    return display;
}

EGLContext create_core_context(EGLDisplay display, EGLContext share, int major, int minor) {
    const std::array<EGLint, 7> attributes{
        EGL_CONTEXT_MAJOR_VERSION,           major,   EGL_CONTEXT_MINOR_VERSION, minor, EGL_CONTEXT_OPENGL_PROFILE_MASK,
        EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
    return eglCreateContext(display, EGL_NO_CONFIG_KHR, share, attributes.data());
}

// What was current on the calling thread, put back at the end of the scope.
class CurrentContextKeeper {
public:
    CurrentContextKeeper()
        : display_{eglGetCurrentDisplay()},
          context_{eglGetCurrentContext()},
          draw_{eglGetCurrentSurface(EGL_DRAW)},
          read_{eglGetCurrentSurface(EGL_READ)} {}
    CurrentContextKeeper(const CurrentContextKeeper&) = delete;
    CurrentContextKeeper& operator=(const CurrentContextKeeper&) = delete;
    ~CurrentContextKeeper() {
        if (display_ != EGL_NO_DISPLAY) eglMakeCurrent(display_, draw_, read_, context_);
    }

private:
    EGLDisplay display_;
    EGLContext context_;
    EGLSurface draw_;
    EGLSurface read_;
};

std::string gl_string(GLenum name) {
    const GLubyte* text = glGetString(name);
    return text == nullptr ? std::string{} : std::string{reinterpret_cast<const char*>(text)};
}

class EglContext final : public Context {
public:
    // `platform` is kPlatformCount for a shared context: it queues with the one it shares with, by choice.
    EglContext(EGLDisplay display, EGLContext context, Platform platform)
        : display_{display}, context_{context}, platform_{platform} {
        const CurrentContextKeeper keeper;
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
        renderer_ = gl_string(GL_RENDERER);
        version_ = gl_string(GL_VERSION);
        apply_conventions();
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        is_software_ = is_software_renderer(renderer_);
        if (is_software_ && platform_ != kPlatformCount) ++software_contexts[platform_];
    }
    ~EglContext() override {
        if (eglGetCurrentContext() == context_) release_current();
        eglDestroyContext(display_, context_);
        if (is_software_ && platform_ != kPlatformCount) --software_contexts[platform_];
    }

    void make_current() override {
        LW_CHECK(eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_TRUE,
                 fmt::format("eglMakeCurrent failed with {:#x}: current on another thread?", eglGetError()));
    }
    void release_current() override { eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }

    [[nodiscard]] const std::string& renderer() const override { return renderer_; }
    [[nodiscard]] const std::string& version() const override { return version_; }
    [[nodiscard]] bool is_software() const override { return is_software_; }
    [[nodiscard]] EglHandles egl_handles() const override { return {display_, context_}; }

private:
    EGLDisplay display_;
    EGLContext context_;
    Platform platform_;
    std::string renderer_;
    std::string version_;
    bool is_software_ = false;
};

Error too_old_error(const std::string& version) {
    return {"OpenGL 4.5 is not there", fmt::format("the driver offers {}", version), kMend};
}

// Why there is no 4.5 context: the version that the driver does offer.
Error no_context_error(EGLDisplay display) {
    const EGLContext context = create_core_context(display, EGL_NO_CONTEXT, 3, 1);
    if (context == EGL_NO_CONTEXT) return {"no OpenGL core profile", "EGL", kMend};
    std::string version;
    {
        const CurrentContextKeeper keeper;
        if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) version = gl_string(GL_VERSION);
        eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
    eglDestroyContext(display, context);
    return too_old_error(version);
}

Result<std::unique_ptr<Context>> create_on(EGLDisplay display, EGLContext share, Platform platform) {
    if (!has_extension(display, "EGL_KHR_surfaceless_context") ||
        !has_extension(display, "EGL_KHR_no_config_context")) {
        return Error{"EGL cannot draw without a window", "EGL_KHR_surfaceless_context", kMend};
    }
    const EGLContext context = create_core_context(display, share, 4, 5);
    if (context == EGL_NO_CONTEXT) return no_context_error(display);
    auto made = std::make_unique<EglContext>(display, context, platform);
    // A driver may be told to claim less than it has (MESA_GL_VERSION_OVERRIDE).
    if (made->version() < "4.5") return too_old_error(made->version());
    return std::unique_ptr<Context>{std::move(made)};
}

}  // namespace

bool is_software_renderer(const std::string& renderer) {
    for (const char* name : {"llvmpipe", "softpipe", "swrast", "SWR", "SwiftShader", "Software Rasterizer"}) {
        if (renderer.find(name) != std::string::npos) return true;
    }
    return false;
}

Result<std::unique_ptr<Context>> Context::create(const Context* share) {
    if (!libraries_exist()) return Error{"EGL and OpenGL libraries are missing", "libEGL.so.1, libGL.so.1", kMend};
    // Per thread, and GLES unless set: without it context creation fails on a fresh thread.
    if (!eglBindAPI(EGL_OPENGL_API)) return Error{"EGL offers no desktop OpenGL", "eglBindAPI", kMend};

    if (share != nullptr) {
        const EglHandles handles = share->egl_handles();
        LW_CHECK(handles.display != nullptr && handles.context != nullptr, "the shared context is not an EGL one");
        return create_on(handles.display, handles.context, kPlatformCount);
    }
    // Counts stay 0 on a GPU, so everybody gets the first display there.
    if (software_contexts[kSurfaceless] > software_contexts[kDevice]) {
        if (const EGLDisplay display = open_display(kDevice); display != EGL_NO_DISPLAY) {
            auto context = create_on(display, EGL_NO_CONTEXT, kDevice);
            if (context.ok()) return context;
        }
    }
    const EGLDisplay surfaceless = open_display(kSurfaceless);
    if (surfaceless != EGL_NO_DISPLAY) return create_on(surfaceless, EGL_NO_CONTEXT, kSurfaceless);
    // Drivers without Mesa's platform offer the device one.
    const EGLDisplay device = open_display(kDevice);
    if (device != EGL_NO_DISPLAY) return create_on(device, EGL_NO_CONTEXT, kDevice);
    return Error{"no EGL driver can be opened", "EGL", kMend};
}

}  // namespace lw::gl
