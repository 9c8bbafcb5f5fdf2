#include "apps/stability/fixed_point_oracle.h"

#include <cmath>

namespace lw::stability {
namespace {

constexpr int kSteps = 3;
constexpr Exact kUnsure_px = 0.02L;
constexpr Exact kAccepted_px = 1.0L;

// Inside the image and not beside a pixel's edge, where rounding may choose the other pixel's depth.
bool is_sure(const ExactVec2& place, const CpuPixels& pixels) {
    const auto sure = [](Exact value, int size) {
        return value > kUnsure_px && value < size - kUnsure_px && std::abs(value - std::round(value)) > kUnsure_px;
    };
    return sure(place.x, pixels.depth.width()) && sure(place.y, pixels.depth.height());
}

}  // namespace

std::optional<SearchedPlace> search_fixed_point(const PictureOracle& oracle, const CpuPixels& pixels, int x, int y) {
    Camera turned = oracle.target();
    turned.world_from_eye.position_m = oracle.of_case().source.world_from_eye.position_m;
    const ExactReprojection rotation{oracle.of_case().source, turned, nullptr};
    const auto homography = ExactHomography::of(rotation, DepthPlane{});
    if (!homography) return std::nullopt;
    const auto start = homography->source_of(x + 0.5L, y + 0.5L);
    if (!start) return std::nullopt;
    SearchedPlace found{start->place_px, 0, 0};
    for (int step = 0; step <= kSteps; ++step) {
        if (!is_sure(found.source_px, pixels)) return std::nullopt;
        const int source_x = static_cast<int>(found.source_px.x);
        const int source_y = static_cast<int>(found.source_px.y);
        found.region = oracle.region_of(source_x, source_y);
        const auto landed = oracle.place(found.region, found.source_px, pixels.depth.at(source_x, source_y));
        if (!landed) return std::nullopt;
        const ExactVec2 error{x + 0.5L - landed->position_px.x, y + 0.5L - landed->position_px.y};
        if (step == kSteps) {
            found.depth = landed->depth;
            if (std::hypot(error.x, error.y) > kAccepted_px - kUnsure_px || found.depth > 0.999L) return std::nullopt;
        } else {
            found.source_px = {found.source_px.x + error.x, found.source_px.y + error.y};
        }
    }
    return found;
}

}  // namespace lw::stability
