#pragma once
/// How large the point of one source pixel must be so that its surface has no cracks in the target.

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/image.h"
#include "core/object_transform.h"

namespace lw {

/// Change of depth per source pixel on the pixel's own surface.
struct DepthGradient {
    float x = 0.0F;
    float y = 0.0F;
};

/// Half extents of a point, target pixels. 0.5 exactly when nothing moves: one write per pixel.
struct Footprint {
    float half_x_px = 0.5F;
    float half_y_px = 0.5F;
};

/// Largest half extent. Growing further mends few cracks and lets the foreground eat its neighbours.
inline constexpr float kLargestHalfExtentPx = 2.0F;

/// A pixel and its neighbour are on one surface when their depths differ by less than this part of the depth.
inline constexpr float kSameSurfaceDepthPart = 0.03F;

/// Of two one-sided differences the first counts as smaller when it is so by this part of the depth.
inline constexpr float kClearlySmallerDepthPart = 1.0F / 1024.0F;

/// The difference to the pixel after, or to the one before where that is clearly smaller (it is the one that stays on
/// the surface beside an edge), or 0 where even that one leaves the surface. `before` and `after` are the neighbours'
/// depths.
[[nodiscard]] inline float one_sided_difference(float depth, float before, float after) {
    const float to_before = depth - before;
    const float to_after = after - depth;
    const bool before_is_smaller = std::abs(to_before) + kClearlySmallerDepthPart * depth < std::abs(to_after);
    const float chosen = before_is_smaller ? to_before : to_after;
    return std::abs(chosen) < kSameSurfaceDepthPart * depth ? chosen : 0.0F;
}

/// Gradient at (x, y); neighbours of other objects count as edges. NaN neighbours count as edges too.
[[nodiscard]] inline DepthGradient depth_gradient(const DepthImage& depth, const ObjectIdImage& object_id, int x,
                                                  int y) {
    const float centre = depth.at(x, y);
    const ObjectId id = object_id.at(x, y);
    const auto neighbour = [&](int at_x, int at_y) {
        const bool inside = at_x >= 0 && at_y >= 0 && at_x < depth.width() && at_y < depth.height();
        if (!inside || object_id.at(at_x, at_y) != id) return 8.0F;  // farther from any depth than 3 %
        const float value = depth.at(at_x, at_y);
        return value >= 0.0F && value <= 1.0F ? value : 8.0F;
    };
    return {one_sided_difference(centre, neighbour(x - 1, y), neighbour(x + 1, y)),
            one_sided_difference(centre, neighbour(x, y - 1), neighbour(x, y + 1))};
}

/// Half the row sums of the absolute Jacobian d(target) / d(source): neighbours' points just touch.
/// @param jacobian_xx  d target x / d source x, and so on; finite
[[nodiscard]] inline Footprint footprint_of(float jacobian_xx, float jacobian_xy, float jacobian_yx,
                                            float jacobian_yy) {
    const auto half_extent = [](float along_x, float along_y) {
        return std::clamp(0.5F * (std::abs(along_x) + std::abs(along_y)), 0.5F, kLargestHalfExtentPx);
    };
    return {half_extent(jacobian_xx, jacobian_xy), half_extent(jacobian_yx, jacobian_yy)};
}

/// Target columns (or rows) whose centres lie in [place - half, place + half), cut to [0, size).
struct PixelRange {
    int begin = 0;
    int end = 0;
};
[[nodiscard]] inline PixelRange pixels_within(float place_px, float half_px, int size) {
    const float limit = static_cast<float>(size);
    const float begin = std::clamp(std::ceil(place_px - half_px - 0.5F), 0.0F, limit);
    const float end = std::clamp(std::ceil(place_px + half_px - 0.5F), 0.0F, limit);
    return {static_cast<int>(begin), static_cast<int>(end)};
}

}  // namespace lw
