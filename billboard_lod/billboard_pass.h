#pragma once
/// Draws billboards into the scene's G-buffer, or lit into a picture.

#include <cstdint>
#include <span>
#include <string>
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
    AtlasPage page;  ///< it lies there
    shader::BillboardRecord record;
    float opacity = 1.0f;  ///< above 0; below 1 in a picture only
};

struct BillboardPassSettings {
    AtlasFormat format = AtlasFormat::packed;
    QuadExpansion expansion = QuadExpansion::vertices;
    bool warped = true;         ///< relief along the pixel's ray, else flat quads
    bool blended = true;        ///< what lies between two texels is between them, else the nearest one shows
    bool into_picture = false;  ///< draw_lit() will be called
    bool point_lights = false;  ///< the scene has some
};

/// Belongs to one GL context and its thread.
class BillboardPass {
public:
    /// A shader that does not compile is an error.
    [[nodiscard]] static Result<BillboardPass> create(const BillboardPassSettings& settings);

    /// Draws opaque `quads` into the framebuffer that is bound (the scene's G-buffer), depth test GL_GEQUAL. `camera`
    /// is that of the records. Leaves the depth test off.
    void draw(std::span<const DrawnQuad> quads, const BillboardAtlas& atlas, const Camera& camera);

    /// Lights `quads` and blends them by their opacity, the least opaque first, into a picture: the framebuffer that is
    /// bound has its colour (encoded: equal steps of opacity are equal steps for the eye) and object ids. The blocks of
    /// the light pass are bound (client_blocks.h). Leaves depth test and blending off.
    void draw_lit(std::span<const DrawnQuad> quads, const BillboardAtlas& atlas, const Camera& camera);

private:
    /// A program and its uniforms.
    struct Way {
        gl::Program program;
        GLint ndc_from_tangent = -1;
        GLint near_m = -1;
        GLint first = -1;  ///< not in the geometry variant
    };

    BillboardPass() = default;
    [[nodiscard]] static Result<Way> compile(QuadExpansion expansion, const std::string& defines);
    void draw(const Way& way, std::span<const DrawnQuad> quads, const BillboardAtlas& atlas, const Camera& camera);
    void draw_range(const Way& way, std::size_t first, std::size_t count) const;

    QuadExpansion expansion_ = QuadExpansion::vertices;
    Way surfaces_;
    Way lit_;             ///< empty unless asked for
    gl::Buffer records_;  ///< mutable storage, replaced per draw
    gl::Buffer active_;   ///< indices of the active ones by page
    gl::VertexArray vertex_array_;
    std::vector<shader::BillboardRecord> record_list_;
    std::vector<std::uint32_t> active_list_;
};

}  // namespace lw
