#pragma once
/// Which terms of the sky show in which part of the picture, so that a pixel works out only those.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/camera.h"
#include "scene/scene.h"
#include "shaders/client_blocks.h"

namespace lw {

/// In the order in which they are drawn.
enum class SkyPart : std::uint8_t {
    ground,  ///< below the horizon, where the ground is all there is
    above,   ///< sky without anything of the sun
    glow,    ///< all but the sun's disc and the halo around it
    sun,     ///< everything
};
inline constexpr int kSkyPartCount = 4;

/// Pixels [first_px, end_px).
struct SkyRect {
    glm::ivec2 first_px{0};
    glm::ivec2 end_px{0};
    SkyPart part = SkyPart::sun;
};

/// What the terms left out add at most, each: linear light. 0.03 of a level of 255 at the ground's brightness.
inline constexpr double kUnseenSkyLight = 1e-4;

/// Keeps its memory between frames. One thread at a time.
class SkyParts {
public:
    /// Rectangles of tiles of kSkyTilePx that cover the picture once.
    void build(const Camera& camera, const scene::Sun& sun);

    /// Sorted by part.
    [[nodiscard]] std::span<const SkyRect> rects() const { return rects_; }

    static constexpr int kSkyTilePx = 32;

private:
    /// Takes in a row of tiles: what goes on below a rectangle makes it higher.
    void go_on();

    std::vector<glm::vec3> corners_;  ///< of the tiles, unit directions, relative
    std::vector<SkyRect> rects_;
    std::vector<SkyRect> open_;  ///< that the next row of tiles may go on
    std::vector<SkyRect> row_;
};

}  // namespace lw
