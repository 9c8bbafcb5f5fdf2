#pragma once
/// Windowless GL 4.5 core contexts through EGL. The only user of EGL.

#include <memory>
#include <string>

#include "core/result.h"

namespace lw::gl {

/// A surfaceless context: draw into framebuffers only. It is current on at most one thread at a time, which is the only
/// one that may use GL objects made in it.
class Context {
public:
    /// No EGL, no driver or GL below 4.5: an error that says which. `share` (may be null) is a context whose textures
    /// and fences this one sees; on a software GL share nothing (contexts of one display share one raster queue there)
    /// and the new context gets a display connection of its own.
    [[nodiscard]] static Result<std::unique_ptr<Context>> create(const Context* share = nullptr);
    virtual ~Context() = default;

    /// Makes it current on the calling thread; it must not be current elsewhere. Sets the project's conventions:
    /// glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE), clear depth 0, depth test GL_GEQUAL.
    virtual void make_current() = 0;
    /// Releases it from the calling thread.
    virtual void release_current() = 0;

    [[nodiscard]] virtual const std::string& renderer() const = 0;  ///< GL_RENDERER
    [[nodiscard]] virtual const std::string& version() const = 0;   ///< GL_VERSION
    /// True on llvmpipe and its like: frames then travel as CPU memory.
    [[nodiscard]] virtual bool is_software() const = 0;
};

/// Errors and warnings the driver reported through KHR_debug on the calling thread since the last call, one line each.
/// Tests fail when there are any.
[[nodiscard]] std::string take_debug_messages();

}  // namespace lw::gl
