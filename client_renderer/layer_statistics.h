#pragma once
/// What a drawn layer says about how long it will stay right.

#include <vector>

#include "frame_link/rendered_frame.h"

namespace lw {

struct LayerStatistics {
    double filled_px = 0.0;      ///< pixels that hold something, sky included
    double surface_px = 0.0;     ///< of those, that hold a surface
    double gap_px_per_m = 0.0;   ///< pixels that open behind its silhouettes when the eye moves sideways by a metre
    double mover_px = 0.0;       ///< pixels of movers
    float nearest_depth = 0.0F;  ///< the largest depth; 0: no surface
    double nearest_ray_m = 0.0;  ///< the shortest distance along a ray; infinity without a surface
    double typical_ray_m = 0.0;  ///< the harmonic mean of the surfaces' distances; infinity without a surface
    std::vector<double> ray_m;   ///< distances of every 64th pixel's surface
};

/// @param layer  with its pixels in CPU memory
/// A gap is counted between neighbours in a row: pixels_per_tangent * |depth a - depth b| / near_m per metre, where
/// both hold something and are not one plane; and again as many for the columns. Pure, any thread.
[[nodiscard]] LayerStatistics statistics_of(const Layer& layer);

}  // namespace lw
