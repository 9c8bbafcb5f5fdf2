#pragma once
/// Antialiasing that the warp can move: NxN samples become one pixel of one surface.

#include <string>

#include "client_renderer/render_targets.h"
#include "core/result.h"
#include "gl/framebuffer.h"
#include "gl/program.h"

namespace lw {

/// What the resolve fills: the images of a layer.
struct LayerTextures {
    gl::Texture colour;     ///< SRGB8_ALPHA8, holds encoded values; alpha: share of the pixel that its surface covers
    gl::Texture depth;      ///< R32F
    gl::Texture object_id;  ///< R16UI
    gl::Framebuffer framebuffer;

    /// Both sides of `size_px` >= 1.
    [[nodiscard]] static Result<LayerTextures> create(glm::ivec2 size_px);
};

/// What it may fill besides: the quarters of those pixels (CpuPixels::quarters).
struct QuarterTexture {
    gl::Texture colour;  ///< SRGB8_ALPHA8, holds encoded values, twice the layer's size
    gl::Framebuffer framebuffer;

    /// Both sides of `layer_size_px` >= 1, and twice them no more than the driver's largest texture.
    [[nodiscard]] static Result<QuarterTexture> create(glm::ivec2 layer_size_px);
};

/// Per pixel the samples are sorted by depth, and the surface of the median one shows: the samples of its object that
/// lie near its plane (shaders/client/resolve_surface.frag). Colour is their mean in linear light, depth that of their
/// plane at the pixel's centre. Background is a surface like others. Belongs to one GL context and its thread.
class SurfaceResolve {
public:
    [[nodiscard]] static Result<SurfaceResolve> create();

    /// Resolves all of `samples` into the part of `layer` that begins at `first_px`; what reaches beyond the layer is
    /// cut off.
    /// @param samples_per_axis  2 or 4; divides the size of `samples`
    void draw(const RenderTargets& samples, int samples_per_axis, glm::ivec2 first_px, const LayerTextures& layer);
    /// The same for what the pixels' surfaces show in their quarters; `first_px` as for the layer.
    void draw_quarters(const RenderTargets& samples, int samples_per_axis, glm::ivec2 first_px,
                       const QuarterTexture& quarters);

private:
    struct Variant {
        gl::Program program;
        GLint first_px = -1;  ///< uniform
    };
    /// For one number of samples per axis.
    struct Variants {
        Variant pixels;
        Variant quarters;
    };

    SurfaceResolve() = default;
    [[nodiscard]] static Result<Variant> make_variant(const std::string& defines);
    [[nodiscard]] static Result<Variants> make_variants(int samples_per_axis);
    [[nodiscard]] const Variants& variants(int samples_per_axis) const;
    void draw(const Variant& variant, const RenderTargets& samples, glm::ivec2 first_px);

    Variants two_;
    Variants four_;
    gl::VertexArray no_attributes_;
};

}  // namespace lw
