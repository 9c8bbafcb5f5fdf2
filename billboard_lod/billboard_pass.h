#pragma once
/// Draws billboards into the scene's G-buffer.

#include <array>
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
};

/// Belongs to one GL context and its thread.
class BillboardPass {
public:
    /// A shader that does not compile is an error. `warped`: relief along the pixel's ray, else flat quads.
    [[nodiscard]] static Result<BillboardPass> create(AtlasFormat format, QuadExpansion expansion, bool warped);

    /// Draws `quads` into the framebuffer that is bound (the scene's G-buffer), depth test GL_GEQUAL. `camera` is that
    /// of the records. Leaves the depth test off.
    void draw(std::span<const DrawnQuad> quads, const BillboardAtlas& atlas, const Camera& camera);

private:
    struct Variant {
        gl::Program program;
        GLint ndc_from_tangent = -1;
        GLint near_m = -1;
        GLint first = -1;  ///< not in the geometry variant
    };

    BillboardPass() = default;
    void draw_level(const Variant& variant, std::size_t first, std::size_t count) const;

    QuadExpansion expansion_ = QuadExpansion::vertices;
    std::array<Variant, 2> variants_;  ///< [1]: dithered
    gl::Buffer records_;               ///< mutable storage, replaced per draw
    gl::Buffer active_;                ///< indices of the active ones by level
    gl::VertexArray vertex_array_;
    std::vector<shader::BillboardRecord> record_list_;
    std::vector<std::uint32_t> active_list_;
};

}  // namespace lw
