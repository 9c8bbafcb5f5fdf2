#pragma once
/// How the billboards get meshes drawn without knowing any: the client implements it.

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

namespace lw {

/// One instance of the scene seen through the frustum of a billboard, into its slot of an atlas. Relative space has the
/// world's axes and its origin in the eye.
struct PaintedView {
    std::uint32_t instance = 0;  ///< index into the scene's instances
    glm::vec4 clip_x{0.0f};      ///< clip.x = dot(clip_x.xyz, position_relative); clip.z = clip_x.w + clip_y.w * clip.w
    glm::vec4 clip_y{0.0f};
    glm::vec4 clip_w{0.0f};
};

/// Belongs to one GL context and its thread.
class ObjectPainter {
public:
    virtual ~ObjectPainter() = default;

    /// Draws all views into the framebuffer that is bound, whose attachments are those of a billboard atlas, viewport
    /// over all of it; depth test GL_GEQUAL. Leaves depth test and face culling off. `eye_world` is the origin of
    /// relative space. The scene's movers stand where they stand in this frame.
    /// @return the number of triangles drawn
    virtual std::uint64_t paint(std::span<const PaintedView> views, const glm::dvec3& eye_world) = 0;

    /// Triangles of an instance: what painting it costs.
    [[nodiscard]] virtual std::uint64_t triangles_of(std::uint32_t instance) const = 0;
};

}  // namespace lw
