#pragma once
/// Which point lights can reach which part of the picture, so that a pixel looks only at those.

#include <cstdint>
#include <vector>

#include "core/camera.h"
#include "scene/scene.h"
#include "shaders/client_blocks.h"

namespace lw {

/// Keeps its memory between frames. One thread at a time.
class LightTiles {
public:
    /// Square tiles of kLightTilePx, the last ones cut by the picture's edge.
    [[nodiscard]] static glm::ivec2 tiles_for(glm::ivec2 size_px);

    /// At most kMaxLights lights. A light is in every tile that its sphere of range may touch, and may be in more.
    void build(const std::vector<scene::PointLight>& lights, const Camera& camera);

    /// One bit per light (x: lights 0-31, y: 32-63) and tile, rows top first.
    [[nodiscard]] const std::vector<glm::uvec2>& masks() const { return masks_; }
    [[nodiscard]] const shader::LightsBlock& block() const { return block_; }

private:
    std::vector<glm::uvec2> masks_;
    shader::LightsBlock block_{};
};

}  // namespace lw
