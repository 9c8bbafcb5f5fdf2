#include "billboard_lod/billboard_plane.h"

#include <algorithm>
#include <cmath>

namespace lw {

namespace {

/// Texels along one axis: the first one's edge and how many, for an extent and a grid of `per_texel` whose lattice has
/// an edge at `lattice`.
struct TexelRange {
    double first = 0.0;
    int count = 0;
};

TexelRange covering(double low, double high, double lattice, double per_texel) {
    const double first = std::floor((low - lattice) / per_texel);
    const double last = std::ceil((high - lattice) / per_texel);
    return {lattice + first * per_texel, std::max(1, static_cast<int>(last - first))};
}

/// The tangents of a projected box.
FovTangents window_of(const ProjectedBounds& bounds, const FovTangents& fov) {
    const auto tangent = [](double low, double high, double ndc) { return low + (high - low) * 0.5 * (ndc + 1.0); };
    return {tangent(fov.left, fov.right, bounds.ndc_min.x), tangent(fov.left, fov.right, bounds.ndc_max.x),
            tangent(fov.down, fov.up, bounds.ndc_min.y), tangent(fov.down, fov.up, bounds.ndc_max.y)};
}

}  // namespace

glm::dvec2 screen_size_px(const ProjectedBounds& bounds, glm::ivec2 viewport_px) {
    return (bounds.ndc_max - bounds.ndc_min) * 0.5 * glm::dvec2{viewport_px};
}

std::size_t nearest_dimension(const glm::dvec2& size_px) {
    const double side_px = std::max(size_px.x, size_px.y);
    std::size_t best = 0;
    for (std::size_t i = 1; i < kBillboardDimensions.size(); ++i) {
        if (std::abs(kBillboardDimensions[i] - side_px) <= std::abs(kBillboardDimensions[best] - side_px)) best = i;
    }
    return best;
}

std::size_t covering_dimension(const glm::dvec2& size_px) {
    const double side_px = std::max(size_px.x, size_px.y);
    for (std::size_t i = 0; i < kBillboardDimensions.size(); ++i) {
        if (kBillboardDimensions[i] >= side_px) return i;
    }
    return kBillboardDimensions.size() - 1;
}

TexelGrid grid_on_pixels(const ProjectedBounds& bounds, const Camera& camera, int texels_per_px) {
    const FovTangents& fov = camera.fov;
    const FovTangents window = window_of(bounds, fov);
    const glm::dvec2 per_px{(fov.right - fov.left) / camera.size_px.x, (fov.up - fov.down) / camera.size_px.y};
    TexelGrid grid;
    grid.per_texel = per_px / static_cast<double>(texels_per_px);
    // With an even number of texels per pixel the lattice is moved by half a texel, so that a texel's centre, not its
    // edge, lies on the pixel's centre. Heights are counted downwards.
    const glm::dvec2 lattice = texels_per_px % 2 == 0 ? 0.5 * grid.per_texel : glm::dvec2{0.0};
    const TexelRange across = covering(window.left, window.right, fov.left + lattice.x, grid.per_texel.x);
    const TexelRange downwards = covering(-window.up, -window.down, -fov.up + lattice.y, grid.per_texel.y);
    grid.left = across.first;
    grid.up = -downwards.first;
    grid.size = {across.count, downwards.count};
    return grid;
}

TexelGrid grid_in_slot(const ProjectedBounds& bounds, const Camera& camera, int texels_per_px, int max_side) {
    const auto fits = [max_side](const TexelGrid& grid) { return std::max(grid.size.x, grid.size.y) <= max_side; };
    TexelGrid grid = grid_on_pixels(bounds, camera, texels_per_px);
    if (fits(grid)) {
        for (int denser = texels_per_px + 1; denser <= kMaxTexelsPerPx; ++denser) {
            const TexelGrid finer = grid_on_pixels(bounds, camera, denser);
            if (!fits(finer)) break;
            grid = finer;
        }
        return grid;
    }
    const FovTangents window = window_of(bounds, camera.fov);
    const glm::dvec2 extent{window.right - window.left, window.up - window.down};
    grid.left = window.left;
    grid.up = window.up;
    grid.per_texel = glm::dvec2{std::max(extent.x, extent.y) / max_side};
    grid.size = glm::clamp(glm::ivec2{glm::ceil(extent / grid.per_texel - 1e-9)}, glm::ivec2{1}, glm::ivec2{max_side});
    return grid;
}

BillboardPlane plane_of(const FovTangents& window, double centre_m) {
    const double x = 0.5 * (window.left + window.right);
    const double y = 0.5 * (window.down + window.up);
    return {{x * centre_m, y * centre_m, -centre_m},
            0.5 * (window.right - window.left) * centre_m,
            0.5 * (window.up - window.down) * centre_m};
}

}  // namespace lw
