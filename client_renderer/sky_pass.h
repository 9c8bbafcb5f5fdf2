#pragma once
/// Draws the sky where nothing else is.

#include <array>
#include <span>
#include <vector>

#include "client_renderer/sky_parts.h"
#include "core/result.h"
#include "gl/handle.h"
#include "gl/program.h"

namespace lw {

/// Belongs to one GL context and its thread.
class SkyPass {
public:
    [[nodiscard]] static Result<SkyPass> create();

    /// Into the framebuffer that is bound, of `size_px`, at depth 0; the depth test is the caller's. The frame block is
    /// bound. `rects` are sorted by part. Leaves no vertex array bound.
    void draw(std::span<const SkyRect> rects, glm::ivec2 size_px);

private:
    SkyPass() = default;

    std::array<gl::Program, kSkyPartCount> programs_;  ///< by SkyPart
    gl::Buffer corners_;                               ///< mutable storage, replaced per draw
    gl::VertexArray vertex_array_;
    std::vector<glm::vec2> corner_list_;  ///< NDC, two triangles each
};

}  // namespace lw
