#include "warp_server/methods/surface_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "warp_server/methods/depth_rows.h"
#include "warp_server/methods/object_matrices.h"
#include "warp_server/methods/surface_classify.h"

namespace lw {
namespace {

// A piece covers the pixels whose centres it holds; this is more than rounding can move it by.
constexpr float kRimPx = 1.0F;
// Of w where distances equal the near plane's: what comes closer to the eye's plane lands far out, inexactly.
constexpr float kLeastW = 1e-3F;
// More than rounding adds to a depth.
constexpr float kDepthRoom = 1.0F + 1e-4F;

void include(const PatchList& list, std::size_t i, RegionBounds& bounds) {
    const float left = list.left[i];
    const float right = list.right[i];
    const float top = list.top[i];
    const float bottom = list.bottom[i];
    bounds.empty = false;
    bounds.static_only = bounds.static_only && list.object_id[i] == 0;
    bounds.left = std::min(bounds.left, list.x[i] + left);
    bounds.right = std::max(bounds.right, list.x[i] + right);
    bounds.top = std::min(bounds.top, list.y[i] + top);
    bounds.bottom = std::max(bounds.bottom, list.y[i] + bottom);
    const glm::vec2 along_x = list.gradient_x[i] * glm::vec2{left, right};
    const glm::vec2 along_y = list.gradient_y[i] * glm::vec2{top, bottom};
    bounds.farthest_depth = std::min(bounds.farthest_depth,
                                     list.depth[i] + std::min(along_x.x, along_x.y) + std::min(along_y.x, along_y.y));
    bounds.nearest_depth =
        std::max(bounds.nearest_depth, list.depth[i] + std::max(along_x.x, along_x.y) + std::max(along_y.x, along_y.y));
}

RegionBounds bounds_between(const PreparedSurface& prepared, const SurfaceRegion& begin, const SurfaceRegion& end) {
    constexpr float kFar = std::numeric_limits<float>::max();
    RegionBounds bounds{kFar, -kFar, kFar, -kFar, kFar, -kFar};
    for (std::size_t i = begin.blocks; i < end.blocks; ++i) include(prepared.blocks, i, bounds);
    for (std::size_t i = begin.patches; i < end.patches; ++i) include(prepared.patches, i, bounds);
    for (std::size_t i = begin.tiles; i < end.tiles; ++i) include(prepared.tiles.surfaces, i, bounds);
    for (std::size_t i = begin.edges; i < end.edges; ++i) include(prepared.edges, i, bounds);
    return bounds;
}

}  // namespace

std::vector<RegionBounds> bounds_of_regions(const PreparedSurface& prepared) {
    std::vector<RegionBounds> bounds;
    bounds.reserve(prepared.regions.size());
    SurfaceRegion begin;
    for (const SurfaceRegion& end : prepared.regions) {
        bounds.push_back(bounds_between(prepared, begin, end));
        begin = end;
    }
    return bounds;
}

std::optional<RegionReach> reach_of(const RegionBounds& bounds, const PixelMatrix& m) {
    if (!bounds.static_only) return std::nullopt;
    glm::vec2 least{std::numeric_limits<float>::max()};
    glm::vec2 most{-std::numeric_limits<float>::max()};
    float nearest = 0.0F;
    for (unsigned corner = 0; corner < 8; ++corner) {
        // Patches count from the centre of their first pixel.
        const float x = ((corner & 1U) != 0 ? bounds.right : bounds.left) + 0.5F;
        const float y = ((corner & 2U) != 0 ? bounds.bottom : bounds.top) + 0.5F;
        const float depth = (corner & 4U) != 0 ? bounds.nearest_depth : bounds.farthest_depth;
        const float w = m.x.w * x + m.y.w * y + m.one.w + m.z.w * depth;
        if (!(w >= kLeastW)) return std::nullopt;
        const glm::vec2 place{(m.x.x * x + m.y.x * y + m.one.x + m.z.x * depth) / w,
                              (m.x.y * x + m.y.y * y + m.one.y + m.z.y * depth) / w};
        least = glm::min(least, place);
        most = glm::max(most, place);
        nearest = std::max(nearest, m.depth_scale * depth / w);
    }
    constexpr float kFarOut = 1e6F;
    least = glm::clamp(least - kRimPx, -kFarOut, kFarOut);
    most = glm::clamp(most + kRimPx, -kFarOut, kFarOut);
    return RegionReach{{glm::ivec2{glm::floor(least)}, glm::ivec2{glm::ceil(most)}}, nearest * kDepthRoom};
}

bool all_nearer(const DepthImage& shown, const PixelRect& rect, float depth) {
    const auto columns = static_cast<std::size_t>(rect.size_px().x);
    for (int y = rect.first_px.y; y < rect.end_px.y; ++y) {
        const float* row = shown.row(y).data() + rect.first_px.x;
        if (count_below(row, columns, depth) > 0) return false;
    }
    return true;
}

}  // namespace lw
