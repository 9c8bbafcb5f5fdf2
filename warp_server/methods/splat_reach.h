#pragma once
/// Where the points of every tile of the source can land in the target.

#include <vector>

#include "warp_server/methods/object_matrices.h"
#include "warp_server/methods/splat_tiles.h"
#include "warp_server/pixel_rect.h"

namespace lw {

/// Rebuilt for every display frame; reuses its memory.
class SplatReach {
public:
    /// Projects the corners of every patch; extents of points and rounding are allowed for.
    void build(const SplatTiles& tiles, const ObjectMatrices& matrices, glm::ivec2 target_size_px);

    /// Target pixels that points of a tile of `band` can write; empty when none of it is seen. Cut to the target.
    [[nodiscard]] const PixelRect& rect_of(int band, int tile) const {
        return rects_[static_cast<std::size_t>(band) * static_cast<std::size_t>(tiles_per_band_) +
                      static_cast<std::size_t>(tile)];
    }
    [[nodiscard]] int bands() const { return bands_; }
    [[nodiscard]] int tiles_per_band() const { return tiles_per_band_; }
    [[nodiscard]] glm::ivec2 target_size_px() const { return target_size_px_; }
    [[nodiscard]] int tiles_outside() const;

private:
    glm::ivec2 target_size_px_{0};
    int bands_ = 0;
    int tiles_per_band_ = 0;
    std::vector<PixelRect> rects_;  // by band and tile
};

}  // namespace lw
