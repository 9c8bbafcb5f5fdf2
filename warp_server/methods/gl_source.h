#pragma once
/// A layer as the GL warp methods read it: three textures and the matrices of its objects.

#include <cstddef>
#include <vector>

#include "gl/handle.h"
#include "gl/texture.h"
#include "shaders/warp_blocks.h"
#include "warp_server/methods/object_matrices.h"
#include "warp_server/warp_method.h"

namespace lw {

/// Belongs to one context and its thread. Uploads layers with CPU pixels; takes textures as they are.
class GlSource {
public:
    GlSource();

    /// Makes `layer` and its matrices for `target` readable at the bindings of shaders/warp_blocks.h, counters at 0.
    /// Colour is bound without sRGB conversion. A layer of textures is one whose fence has signalled.
    void bind(const Layer& layer, const WarpTarget& target);

    /// What the shaders counted since bind(). Waits for them.
    [[nodiscard]] WarpCounters counters() const;

    /// Of the layer bound last.
    [[nodiscard]] const ObjectMatrices& matrices() const { return matrices_; }

private:
    void upload(const CpuPixels& pixels);
    void bind_objects();

    gl::Texture colour_;
    gl::Texture depth_;
    gl::Texture object_id_;
    gl::Handle<gl::TextureTraits> colour_view_;  ///< a texture layer's sRGB colour, seen as plain bytes
    gl::Buffer objects_;
    gl::Buffer counters_;
    std::size_t object_capacity_ = 0;
    ObjectMatrices matrices_;
    std::vector<glsl::WarpObject> packed_;
};

}  // namespace lw
