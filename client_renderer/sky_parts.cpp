#include "client_renderer/sky_parts.h"

#include <algorithm>
#include <cmath>

#include "client_renderer/frame_block.h"

namespace lw {

namespace {

/// Cosine of the angle to the sun below which `share` of its irradiance, by a power of the cosine, is not seen.
float least_cosine(double share, double power, const glm::vec3& irradiance) {
    const double brightest = share * std::max({irradiance.r, irradiance.g, irradiance.b, 1e-9f});
    return static_cast<float>(std::pow(kUnseenSkyLight / brightest, 1.0 / power));
}

/// Tells the part of a tile from the directions of its corners.
class PartOfTile {
public:
    explicit PartOfTile(const scene::Sun& sun)
        : to_sun_{sun.direction_to_sun_world},
          glow_cosine_{least_cosine(shader::kSunGlow, 8.0, sun.irradiance)},
          halo_cosine_{least_cosine(shader::kSunHalo, 96.0, sun.irradiance)} {}

    /// The directions are unit, in any order.
    [[nodiscard]] SkyPart operator()(std::span<const glm::vec3, 4> corners) const {
        const float cosine = greatest_cosine(corners);
        if (cosine > halo_cosine_) return SkyPart::sun;
        if (cosine > glow_cosine_) return SkyPart::glow;
        // Directions above, and those so far below the horizon, are convex cones: the corners speak for the tile.
        const auto [lowest, highest] =
            std::ranges::minmax(corners, {}, [](const glm::vec3& corner) { return corner.y; });
        if (lowest.y >= kMargin) return SkyPart::above;
        return highest.y <= -shader::kHorizonBlend - kMargin ? SkyPart::ground : SkyPart::glow;
    }

private:
    static constexpr float kMargin = 1e-4f;  ///< for the shader's rounding

    /// Of the angle to the sun over a tile: no direction in it is farther from its middle than a corner.
    [[nodiscard]] float greatest_cosine(std::span<const glm::vec3, 4> corners) const {
        const glm::vec3 middle = glm::normalize(corners[0] + corners[1] + corners[2] + corners[3]);
        float radius_cosine = 1.0f;
        for (const glm::vec3& corner : corners) radius_cosine = std::min(radius_cosine, glm::dot(middle, corner));
        const float cosine = glm::dot(middle, to_sun_);
        if (cosine >= radius_cosine) return 1.0f;
        const auto sine_of = [](float c) { return std::sqrt(std::max(1.0f - c * c, 0.0f)); };
        return cosine * radius_cosine + sine_of(cosine) * sine_of(radius_cosine) + kMargin;
    }

    glm::vec3 to_sun_;
    float glow_cosine_;
    float halo_cosine_;
};

}  // namespace

void SkyParts::build(const Camera& camera, const scene::Sun& sun) {
    const glm::ivec2 tiles = (camera.size_px + kSkyTilePx - 1) / kSkyTilePx;
    const auto px_of = [&](glm::ivec2 tile) { return glm::min(tile * kSkyTilePx, camera.size_px); };
    const shader::FrameBlock block = frame_block(camera, sun);
    corners_.clear();
    for (int y = 0; y <= tiles.y; ++y) {
        for (int x = 0; x <= tiles.x; ++x) {
            const glm::vec2 px{px_of({x, y})};
            const glm::vec4 ray = block.ray_origin + px.x * block.ray_per_px_x + px.y * block.ray_per_px_y;
            corners_.push_back(glm::normalize(glm::vec3{ray}));
        }
    }

    const PartOfTile part_of{sun};
    const auto corner = [&](int x, int y) {
        return corners_[static_cast<std::size_t>(y) * static_cast<std::size_t>(tiles.x + 1) +
                        static_cast<std::size_t>(x)];
    };
    rects_.clear();
    open_.clear();
    for (int y = 0; y < tiles.y; ++y) {
        row_.clear();
        for (int x = 0; x < tiles.x; ++x) {
            const std::array<glm::vec3, 4> corners{corner(x, y), corner(x + 1, y), corner(x, y + 1),
                                                   corner(x + 1, y + 1)};
            const SkyPart part = part_of(corners);
            if (row_.empty() || row_.back().part != part) row_.push_back({px_of({x, y}), {}, part});
            row_.back().end_px = px_of({x + 1, y + 1});
        }
        go_on();
    }
    rects_.insert(rects_.end(), open_.begin(), open_.end());
    std::ranges::stable_sort(rects_, {}, &SkyRect::part);
}

void SkyParts::go_on() {
    for (SkyRect& run : row_) {
        const auto above = std::ranges::find_if(open_, [&](const SkyRect& rect) {
            return rect.part == run.part && rect.first_px.x == run.first_px.x && rect.end_px.x == run.end_px.x;
        });
        if (above == open_.end()) continue;
        run.first_px.y = above->first_px.y;
        open_.erase(above);
    }
    rects_.insert(rects_.end(), open_.begin(), open_.end());
    open_.swap(row_);
}

}  // namespace lw
