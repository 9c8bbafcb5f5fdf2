#pragma once
/// Full-screen passes over finished images: the box average of supersampling, and depth as a colour texture.

#include "core/result.h"
#include "gl/framebuffer.h"
#include "gl/program.h"
#include "gl/texture.h"

namespace lw {

/// Belongs to one GL context and its thread.
class ImagePasses {
public:
    [[nodiscard]] static Result<ImagePasses> create();

    /// Averages samples_per_axis squared pixels of `source` (SRGB8_ALPHA8, that many times as large) into one of
    /// `target` (SRGB8_ALPHA8), in linear light.
    void average(const gl::Texture& source, int samples_per_axis, const gl::Texture& target);

    /// Copies a depth texture into an R32F one of the same size.
    void copy_depth(const gl::Texture& depth, const gl::Texture& target);

private:
    ImagePasses() = default;
    void draw(const gl::Program& program, const gl::Texture& source, const gl::Texture& target);

    gl::Program average_;
    gl::Program depth_copy_;
    GLint samples_per_axis_ = -1;  ///< uniform of average_
    gl::VertexArray no_attributes_;
};

}  // namespace lw
