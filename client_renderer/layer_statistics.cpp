#include "client_renderer/layer_statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lw {
namespace {

// A head that moves a metre opens no gap that is wider than what it sees: surfaces that near come with a new picture.
constexpr double kWidestGap_px = 64.0;

// Depth that a moved eye sees come apart between a and b, or 0 where they are one plane.
float gap_between(std::span<const float> row, std::size_t x) {
    const float a = row[x];
    const float b = row[x + 1];
    if (a < 0.0F || b < 0.0F) return 0.0F;
    const float step = std::abs(a - b);
    if (step <= 0.02F * std::max(a, b)) return 0.0F;
    const float before = x > 0 ? row[x - 1] : -1.0F;
    const float after = x + 2 < row.size() ? row[x + 2] : -1.0F;
    const bool goes_on = (before > 0.0F && std::abs(b - 2.0F * a + before) < 0.5F * step) ||
                         (after > 0.0F && std::abs(after - 2.0F * b + a) < 0.5F * step);
    return goes_on ? 0.0F : step;
}

double ray_length(const Camera& camera, int x, int y) {
    const FovTangents& fov = camera.fov;
    const double right = fov.left + (fov.right - fov.left) * (x + 0.5) / camera.size_px.x;
    const double up = fov.up - (fov.up - fov.down) * (y + 0.5) / camera.size_px.y;
    return std::sqrt(right * right + up * up + 1.0);
}

}  // namespace

LayerStatistics statistics_of(const Layer& layer) {
    const Camera& camera = layer.camera;
    const CpuPixels& pixels = layer.cpu();
    const double px_per_tan = camera.size_px.x / (camera.fov.right - camera.fov.left);
    LayerStatistics statistics;
    statistics.nearest_ray_m = std::numeric_limits<double>::infinity();
    double inverse_sum = 0.0;
    for (int y = 0; y < camera.size_px.y; ++y) {
        const std::span<const float> row = pixels.depth.row(y);
        const std::span<const ObjectId> ids = pixels.object_id.row(y);
        for (std::size_t x = 0; x < row.size(); ++x) {
            const float depth = row[x];
            if (!(depth >= 0.0F)) continue;
            statistics.filled_px += 1.0;
            if (ids[x] != 0) statistics.mover_px += 1.0;
            if (x + 1 < row.size()) {
                const double gap = gap_between(row, x);
                statistics.gap_px_per_m += std::min(0.5 * px_per_tan * gap / camera.near_m, kWidestGap_px);
            }
            if (depth == 0.0F) continue;
            statistics.surface_px += 1.0;
            statistics.nearest_depth = std::max(statistics.nearest_depth, depth);
            const double ray_m = ray_length(camera, static_cast<int>(x), y) * camera.near_m / depth;
            statistics.nearest_ray_m = std::min(statistics.nearest_ray_m, ray_m);
            inverse_sum += 1.0 / ray_m;
            if (x % 8 == 4 && y % 8 == 4) statistics.ray_m.push_back(ray_m);
        }
    }
    statistics.typical_ray_m =
        inverse_sum > 0.0 ? statistics.surface_px / inverse_sum : std::numeric_limits<double>::infinity();
    return statistics;
}

}  // namespace lw
