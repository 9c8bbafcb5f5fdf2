#pragma once
/// Draws instances of the scene into billboards' slots, with the shaders that fill the G-buffer.

#include <array>
#include <vector>

#include "billboard_lod/billboard_atlas.h"
#include "billboard_lod/object_painter.h"
#include "client_renderer/draw_list.h"
#include "client_renderer/gpu_scene.h"
#include "core/result.h"
#include "scene/scene.h"

namespace lw {

/// One instance in one view, as the GPU reads it.
struct PackedView {
    PackedInstance instance;
    glm::vec4 clip_x{0.0f};
    glm::vec4 clip_y{0.0f};
    glm::vec4 clip_w{0.0f};
};
static_assert(sizeof(PackedView) == 100);

/// Belongs to one GL context and its thread.
class BillboardPainter final : public ObjectPainter {
public:
    /// `scene`, `state` (at the time to draw) and `gpu_scene`, which has programs for billboards, outlive the painter.
    BillboardPainter(const scene::Scene& scene, const scene::SceneState& state, const GpuScene& gpu_scene);

    std::uint64_t paint(std::span<const PaintedView> views, const glm::dvec3& eye_world) override;
    [[nodiscard]] std::uint64_t triangles_of(std::uint32_t instance) const override;

private:
    struct Range {
        std::uint32_t first = 0;
        std::uint32_t count = 0;
    };

    void pack(std::span<const PaintedView> views, const glm::dvec3& eye_world);
    std::uint64_t submit();

    const scene::Scene& scene_;
    const scene::SceneState& state_;
    const GpuScene& gpu_scene_;
    gl::Buffer views_;  ///< mutable storage, replaced per draw
    gl::Buffer commands_;
    gl::VertexArray vertex_array_;
    std::vector<PackedView> packed_;
    std::array<std::vector<Range>, 2> ranges_;  ///< by mesh; [1] the mirrored ones
    std::vector<DrawCommand> command_list_;
};

}  // namespace lw
