#include "warp_server/methods/surface_classify.h"

#include <algorithm>
#include <cmath>

#include "warp_server/methods/object_matrices.h"

namespace lw {
namespace {

// A step of 1 % of the depth displaces the parallax by as much: 0.5 px for a head that moved 10 cm before something
// 1 m away, which is less than what a wrong edge would show.
constexpr float kLevelDepthPart = 0.01F;
// Samples averaged per surface sit up to a quarter of a pixel beside the pixel's centre, so slopes differ by half of
// themselves at worst between two neighbours of one plane.
constexpr float kSlopeChangePart = 0.5F;
// A pixel of a tile may lie off the tile's plane by this part of its depth: 0.05 px for 10 cm of motion at 1 m.
constexpr float kPlaneDepthPart = 1e-3F;

constexpr float kBad = -1.0F;  // stands for every unusable depth: it is on no surface

class Classifier {
public:
    explicit Classifier(const CpuPixels& pixels) : pixels_{&pixels}, size_px_{pixels.depth.size_px()} {}

    [[nodiscard]] std::shared_ptr<const PreparedSurface> classify() const {
        auto prepared = std::make_shared<PreparedSurface>();
        prepared->size_px = size_px_;
        prepared->tiles = (size_px_ + kTileCells - 1) / kTileCells;
        prepared->cell_links.resize(size_px_);
        for (int y = 0; y < size_px_.y; ++y) {
            for (int x = 0; x < size_px_.x; ++x) prepared->cell_links.at(x, y) = links_of_cell(x, y);
        }
        for (int row = 0; row < prepared->tiles.y; ++row) {
            for (int column = 0; column < prepared->tiles.x; ++column) {
                prepared->tile.push_back(tile_from(column * kTileCells, row * kTileCells));
            }
        }
        return prepared;
    }

private:
    [[nodiscard]] glm::ivec2 clamped(int x, int y) const {
        return {std::clamp(x, 0, size_px_.x - 1), std::clamp(y, 0, size_px_.y - 1)};
    }

    [[nodiscard]] ObjectId id_at(int x, int y) const {
        const glm::ivec2 at = clamped(x, y);
        return pixels_->object_id.at(at.x, at.y);
    }

    // kBad where the pixel is of another object than `id` or its depth cannot be used.
    [[nodiscard]] float depth_of(ObjectId id, int x, int y) const {
        const glm::ivec2 at = clamped(x, y);
        const float depth = pixels_->depth.at(at.x, at.y);
        return pixels_->object_id.at(at.x, at.y) == id && is_usable_depth(depth) ? depth : kBad;
    }

    [[nodiscard]] bool linked(int x, int y, int step_x, int step_y) const {
        const ObjectId id = id_at(x, y);
        return on_one_surface(depth_of(id, x - step_x, y - step_y), depth_of(id, x, y),
                              depth_of(id, x + step_x, y + step_y), depth_of(id, x + 2 * step_x, y + 2 * step_y));
    }

    [[nodiscard]] std::uint8_t links_of_cell(int x, int y) const {
        int links = 0;
        if (linked(x, y, 1, 0)) links |= kLinkTop;
        if (linked(x, y + 1, 1, 0)) links |= kLinkBottom;
        if (linked(x, y, 0, 1)) links |= kLinkLeft;
        if (linked(x + 1, y, 0, 1)) links |= kLinkRight;
        if (linked(x, y, 1, 1)) links |= kLinkFalling;
        if (linked(x + 1, y, -1, 1)) links |= kLinkRising;
        return static_cast<std::uint8_t>(links);
    }

    [[nodiscard]] SurfaceTile tile_from(int x0, int y0) const {
        const int x1 = std::min(x0 + kTileCells, size_px_.x - 1);
        const int y1 = std::min(y0 + kTileCells, size_px_.y - 1);
        const ObjectId id = id_at(x0, y0);
        SurfaceTile tile{TileKind::cells, id, depth_of(id, x0, y0), 0.0F, 0.0F};
        if (x1 > x0) tile.gradient_x = (depth_of(id, x1, y0) - tile.depth) / static_cast<float>(x1 - x0);
        if (y1 > y0) tile.gradient_y = (depth_of(id, x0, y1) - tile.depth) / static_cast<float>(y1 - y0);
        for (int y = y0; y <= y1; ++y) {
            for (int x = x0; x <= x1; ++x) {
                const float depth = depth_of(id, x, y);
                const float expected = tile.depth + static_cast<float>(x - x0) * tile.gradient_x +
                                       static_cast<float>(y - y0) * tile.gradient_y;
                if (depth < 0.0F || std::abs(depth - expected) > kPlaneDepthPart * depth) return tile;
            }
        }
        tile.kind = TileKind::plane;
        return tile;
    }

    const CpuPixels* pixels_;
    glm::ivec2 size_px_;
};

}  // namespace

bool on_one_surface(float before, float a, float b, float after) {
    if (a < 0.0F || b < 0.0F) return false;
    if (a == 0.0F || b == 0.0F) return a == b;  // background is its own surface
    const float step = b - a;
    if (std::abs(step) <= kLevelDepthPart * std::min(a, b)) return true;
    const float allowed = kSlopeChangePart * std::abs(step);
    const bool continues_before = before > 0.0F && std::abs(step - (a - before)) <= allowed;
    const bool continues_after = after > 0.0F && std::abs(step - (after - b)) <= allowed;
    return continues_before || continues_after;
}

std::shared_ptr<const PreparedSurface> classify_surfaces(const CpuPixels& pixels) {
    return Classifier{pixels}.classify();
}

}  // namespace lw
