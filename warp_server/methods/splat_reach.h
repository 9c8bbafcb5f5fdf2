#pragma once
/// Where the points of every tile of the source can land in the target.

#include <vector>

#include "warp_server/methods/object_matrices.h"
#include "warp_server/methods/splat_tiles.h"
#include "warp_server/pixel_rect.h"

namespace lw {

/// Where the points of a tile land, as seen from a part of the target.
enum class TileLanding : std::uint8_t {
    outside,   ///< no pixel of it can be seen there
    crossing,  ///< some may land outside
    inside,    ///< all are in front of the near plane and land inside, with all pixels that they cover
};

/// Rebuilt for every display frame; reuses its memory.
class SplatReach {
public:
    /// Projects the corners of every patch; extents of points and rounding are allowed for.
    void build(const SplatTiles& tiles, const ObjectMatrices& matrices, glm::ivec2 target_size_px,
               TaskPool* threads = nullptr);

    /// Target pixels that points of a tile of `band` can write; empty when none of it is seen. Cut to the target.
    [[nodiscard]] const PixelRect& rect_of(int band, int tile) const { return rects_[index(band, tile)]; }
    /// All points of the tile land within rect_of(), which nothing was cut from.
    [[nodiscard]] bool lands_whole(int band, int tile) const { return cut_[index(band, tile)] == 0; }
    [[nodiscard]] int bands() const { return bands_; }
    [[nodiscard]] int tiles_per_band() const { return tiles_per_band_; }
    [[nodiscard]] glm::ivec2 target_size_px() const { return target_size_px_; }
    [[nodiscard]] int tiles_outside() const;

private:
    void place_band(const SplatTiles& tiles, const ObjectMatrices& matrices, int band);
    [[nodiscard]] std::size_t index(int band, int tile) const {
        return static_cast<std::size_t>(band) * static_cast<std::size_t>(tiles_per_band_) +
               static_cast<std::size_t>(tile);
    }

    glm::ivec2 target_size_px_{0};
    int bands_ = 0;
    int tiles_per_band_ = 0;
    // By band and tile.
    std::vector<PixelRect> rects_;
    std::vector<std::uint8_t> cut_;  // 1 where some points land beside the target, or nobody knows
};

}  // namespace lw
