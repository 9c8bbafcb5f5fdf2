#pragma once
/// What a region of a prepared layer can reach in a picture: so whole regions are passed over before any of their
/// pieces is placed.

#include <optional>
#include <vector>

#include "core/image.h"
#include "warp_server/pixel_rect.h"

namespace lw {

struct PixelMatrix;
struct PreparedSurface;

/// A box of source pixels and depths that holds all planes of a region where they are drawn.
struct RegionBounds {
    float left = 0.0F;
    float right = 0.0F;
    float top = 0.0F;
    float bottom = 0.0F;
    float farthest_depth = 0.0F;
    float nearest_depth = 0.0F;
    bool static_only = true;  ///< false: it may hold movers, and nothing is known of where those are
    bool empty = true;        ///< no pieces: the rest says nothing
};

/// One for each region of `prepared`. Pure, any thread.
[[nodiscard]] std::vector<RegionBounds> bounds_of_regions(const PreparedSurface& prepared);

/// Where a region lands.
struct RegionReach {
    PixelRect rect;              ///< all of its pixels, and a few more; may lie outside of the picture
    float nearest_depth = 0.0F;  ///< in the target
};

/// Nothing where it may land anywhere: with movers, or partly behind the target eye. Pure, any thread.
/// @param target_from_source  of what does not move
[[nodiscard]] std::optional<RegionReach> reach_of(const RegionBounds& bounds, const PixelMatrix& target_from_source);

/// Whether all pixels of `rect`, which lies within the picture, show something nearer than `depth`. Pure, any thread.
[[nodiscard]] bool all_nearer(const DepthImage& shown, const PixelRect& rect, float depth);

}  // namespace lw
