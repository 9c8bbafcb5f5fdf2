#pragma once
/// Draws billboards into the scene's G-buffer.

#include <cstdint>
#include <span>
#include <vector>

#include "billboard_lod/billboard_atlas.h"
#include "core/camera.h"
#include "core/result.h"
#include "gl/program.h"
#include "shaders/billboard_blocks.h"

namespace lw {

/// How one vertex, or none, becomes a quad.
enum class QuadExpansion : std::uint8_t {
    geometry,   ///< a point per billboard and a geometry shader
    instances,  ///< an instance of four vertices per billboard
    vertices,   ///< six vertices per billboard, told apart by their number
};

/// One billboard of a frame.
struct DrawnQuad {
    std::size_t level = 0;  ///< the atlas it lies in
    shader::BillboardRecord record;
    float opacity = 1.0f;   ///< above 0
    bool replaces = false;  ///< a new version, drawn over the old one
};

/// Belongs to one GL context and its thread.
class BillboardPass {
public:
    /// A shader that does not compile is an error. `warped`: relief along the pixel's ray, else flat quads.
    [[nodiscard]] static Result<BillboardPass> create(AtlasFormat format, QuadExpansion expansion, bool warped);

    /// Draws `quads` into the framebuffer that is bound (the scene's G-buffer), depth test GL_GEQUAL: what is opaque
    /// and replaces nothing first, new versions last. `camera` is that of the records. Leaves depth test and blending
    /// off.
    void draw(std::span<const DrawnQuad> quads, const BillboardAtlas& atlas, const Camera& camera);

private:
    BillboardPass() = default;
    void draw_range(std::size_t first, std::size_t count) const;

    QuadExpansion expansion_ = QuadExpansion::vertices;
    gl::Program program_;
    GLint ndc_from_tangent_ = -1;
    GLint near_m_ = -1;
    GLint first_ = -1;    ///< not in the geometry variant
    gl::Buffer records_;  ///< mutable storage, replaced per draw
    gl::Buffer active_;   ///< indices of the active ones by level
    gl::VertexArray vertex_array_;
    std::vector<shader::BillboardRecord> record_list_;
    std::vector<std::uint32_t> active_list_;
};

}  // namespace lw
