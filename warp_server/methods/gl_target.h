#pragma once
/// What the GL warp methods that draw render into: colour, coverage and depth.

#include "core/result.h"
#include "gl/framebuffer.h"
#include "gl/texture.h"
#include "warp_server/warp_method.h"

namespace lw {

/// Belongs to one context and its thread. Keeps its textures while the size stays.
class GlTarget {
public:
    /// What the shader writes as colour.
    enum class Writes { stored_bytes, linear_light };

    /// Binds a framebuffer of `size_px` with attachments 0 (colour, SRGB8_ALPHA8), 1 (coverage, R8UI) and depth (32
    /// bit); everything a hole, depth 0, nearest wins (GL_GEQUAL), no blending and no culling. Programmer error when
    /// the driver cannot (GL 4.5 demands these formats).
    void begin(glm::ivec2 size_px, Writes writes);

    [[nodiscard]] const gl::Texture& colour() const { return colour_; }
    [[nodiscard]] const gl::Texture& coverage() const { return coverage_; }
    [[nodiscard]] const gl::Texture& depth() const { return depth_; }

    /// Reads the picture back; waits for the GPU. `out` is resized.
    void read(DisplayFrame& out) const;

private:
    gl::Texture colour_;
    gl::Texture coverage_;
    gl::Texture depth_;
    gl::Framebuffer framebuffer_;
};

}  // namespace lw
