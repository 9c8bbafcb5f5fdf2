#pragma once
/// What the GL warp methods that compute write: colour, depth and coverage as images.

#include "gl/texture.h"
#include "warp_server/warp_method.h"

namespace lw {

/// Belongs to one context and its thread. Keeps its textures while the size stays.
class GlImages {
public:
    /// Makes images of `size_px` writable at the bindings of shaders/warp_blocks.h. Their contents are undefined: the
    /// shaders write every pixel.
    void begin(glm::ivec2 size_px);

    /// Reads the picture back; waits for the GPU. `out` is resized.
    void read(DisplayFrame& out) const;

private:
    gl::Texture colour_;
    gl::Texture depth_;
    gl::Texture coverage_;
};

}  // namespace lw
