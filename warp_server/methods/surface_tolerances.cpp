#include "warp_server/methods/surface_tolerances.h"

namespace lw {

float unseen_depth_step(const Camera& source) {
    constexpr double kShift_px = 0.1;
    constexpr double kMotion_m = 0.1;
    const double pixels_per_tangent = source.size_px.x / (source.fov.right - source.fov.left);
    return static_cast<float>(kShift_px * source.near_m / (kMotion_m * pixels_per_tangent));
}

}  // namespace lw
