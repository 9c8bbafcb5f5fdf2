#pragma once
/// A layer as the GL warp methods read it: three textures and the matrices of its objects.

#include <cstddef>
#include <vector>

#include "gl/handle.h"
#include "gl/program.h"
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
    /// A layer of textures is one whose fence has signalled.
    void bind(const Layer& layer, const WarpTarget& target);

    /// What the shaders counted since bind(). Waits for them.
    [[nodiscard]] WarpCounters counters() const;

    /// Of the layer bound last.
    [[nodiscard]] const ObjectMatrices& matrices() const { return matrices_; }

private:
    void upload(const CpuPixels& pixels);
    void bind_textures(GLuint colour, GLuint depth, GLuint object_id);
    void bind_objects();

    gl::Texture colour_;
    gl::Texture depth_;
    gl::Texture object_id_;
    gl::Handle<gl::TextureTraits> colour_view_;  ///< the sRGB colour seen as plain bytes
    gl::Sampler smooth_;
    gl::Buffer objects_;
    gl::Buffer counters_;
    std::size_t object_capacity_ = 0;
    ObjectMatrices matrices_;
    std::vector<glsl::WarpObject> packed_;
};

/// Counts the bad pixels of the layer bound last, for methods whose shaders do not visit each source pixel once.
class GlBadPixelCounter {
public:
    [[nodiscard]] static Result<GlBadPixelCounter> create();
    /// Adds to the counters that GlSource::bind() has set to 0.
    void count(glm::ivec2 source_size_px) const;

private:
    explicit GlBadPixelCounter(gl::Program program);
    gl::Program program_;
    GLint source_size_ = -1;
};

/// Work groups of 16x16 invocations that cover `size_px`.
[[nodiscard]] inline glm::uvec2 work_groups(glm::ivec2 size_px) { return (glm::uvec2{size_px} + 15U) / 16U; }

}  // namespace lw
