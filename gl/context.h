#pragma once
/// Windowless GL 4.5 core contexts through EGL. The only user of EGL.

#include <memory>
#include <string>

#include "core/result.h"

namespace lw::gl {

/// An EGL display connection and a context on it, for sharing; null where there is none.
struct EglHandles {
    void* display = nullptr;  ///< EGLDisplay
    void* context = nullptr;  ///< EGLContext
};

/// A context; it is current on at most one thread at a time, which is the only one that may use GL objects made in it.
/// Framebuffer 0 of a surfaceless one is undefined: draw into framebuffers only.
class Context {
public:
    /// A surfaceless context, not current anywhere. No EGL, no driver or GL below 4.5: an error that says which.
    /// `share` (may be null, may be a window's) is a context whose textures and fences this one sees; it may be current
    /// on any thread. Contexts that are not shared: on a GPU they use one display connection, on a software GL the
    /// first gets one and the second another with its own raster queue; Mesa has no third (platforms "surfaceless" and
    /// "device"), so from then on they take turns. There a 1 ms draw waited 450 ms behind another context's draws on
    /// the same display, and 0.5 ms on the other. Display connections are never terminated: EGL hands the same one to
    /// everybody in the process. Any thread.
    [[nodiscard]] static Result<std::unique_ptr<Context>> create(const Context* share = nullptr);
    Context() = default;
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;
    virtual ~Context() = default;

    /// Makes it current on the calling thread; it must not be current elsewhere. The first time it also applies
    /// apply_conventions().
    virtual void make_current() = 0;
    /// Releases it from the calling thread.
    virtual void release_current() = 0;

    [[nodiscard]] virtual const std::string& renderer() const = 0;  ///< GL_RENDERER
    [[nodiscard]] virtual const std::string& version() const = 0;   ///< GL_VERSION
    /// True on llvmpipe and its like: frames then travel as CPU memory.
    [[nodiscard]] virtual bool is_software() const = 0;
    [[nodiscard]] virtual EglHandles egl_handles() const = 0;
};

/// Sets the project's conventions in the current context: glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE), clear depth 0,
/// depth function GL_GEQUAL with the test off, pixel rows tightly packed; and collects the driver's messages. For
/// contexts made elsewhere (a window's); Context::create()'s have it.
void apply_conventions();

/// True for a GL_RENDERER string of a rasteriser that runs on the CPU.
[[nodiscard]] bool is_software_renderer(const std::string& renderer);

/// Errors and warnings the driver reported through KHR_debug on the calling thread since the last call, one line each;
/// notes about performance are left out. Tests fail when there are any.
[[nodiscard]] std::string take_debug_messages();

}  // namespace lw::gl
