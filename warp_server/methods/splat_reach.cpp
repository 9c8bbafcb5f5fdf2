#include "warp_server/methods/splat_reach.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/task_pool.h"
#include "warp_server/methods/row_range.h"
#include "warp_server/methods/splat_footprint.h"

namespace lw {
namespace {

// Beyond a point's largest extent: the rounding of its place, which stays below 0.1 px while w is no small difference
// of large terms (see kLeastPartOfW).
constexpr float kMargin_px = kLargestHalfExtentPx + 1.0F;
constexpr float kLeastPartOfW = 1e-3F;
// In the target; 1 is the near plane.
constexpr float kGreatestDepth = 0.999F;

constexpr std::size_t kBandsPerTask = 4;  // some microseconds

struct Box {
    float begin_x, end_x, begin_y, end_y, least_depth, greatest_depth;
};

struct Extent {
    float least = 0.0F;
    float greatest = 0.0F;
};

struct BoxReach {
    enum class Kind : std::uint8_t { behind, bounded, anywhere };
    Kind kind = Kind::anywhere;  // what comes close to the eye plane may land anywhere
    Extent x;
    Extent y;
    float greatest_depth = 0.0F;  // in the target
};

constexpr int kCorners = 8;
using Corners = std::array<float, kCorners>;

Extent extent_of(const Corners& values) {
    float least = values[0];
    float greatest = values[0];
    for (const float value : values) {
        least = value < least ? value : least;
        greatest = value > greatest ? value : greatest;
    }
    return {least, greatest};
}

// Places and depths are quotients of affine functions of x, y and depth. Where the divisor stays positive, such a
// quotient is monotone along every edge of the box, so it is bounded by its values at the corners.
BoxReach reach_of(const Box& box, const PixelMatrix& m) {
    // Plain loops of fixed length: the compiler makes vectors of them.
    Corners at_x;
    Corners at_y;
    Corners depth;
    for (int i = 0; i < kCorners; ++i) {
        at_x[i] = (i & 1) != 0 ? box.end_x : box.begin_x;
        at_y[i] = (i & 2) != 0 ? box.end_y : box.begin_y;
        depth[i] = (i & 4) != 0 ? box.greatest_depth : box.least_depth;
    }
    Corners w;
    for (int i = 0; i < kCorners; ++i) w[i] = m.one.w + at_y[i] * m.y.w + at_x[i] * m.x.w + depth[i] * m.z.w;
    const Extent all_w = extent_of(w);
    if (all_w.greatest <= 0.0F) return {BoxReach::Kind::behind, {}, {}, 0.0F};
    // At the corner where its terms are largest.
    const float size_of_w = std::abs(m.one.w) + std::abs(box.end_y * m.y.w) + std::abs(box.end_x * m.x.w) +
                            std::abs(box.greatest_depth * m.z.w);
    if (!(all_w.least > kLeastPartOfW * size_of_w)) return {};
    Corners x;
    Corners y;
    for (int i = 0; i < kCorners; ++i) {
        x[i] = (m.one.x + at_y[i] * m.y.x + at_x[i] * m.x.x + depth[i] * m.z.x) / w[i];
        y[i] = (m.one.y + at_y[i] * m.y.y + at_x[i] * m.x.y + depth[i] * m.z.y) / w[i];
        depth[i] = depth[i] * m.depth_scale / w[i];
    }
    return {BoxReach::Kind::bounded, extent_of(x), extent_of(y), extent_of(depth).greatest};
}

// Pixels whose centres may lie in the extent, cut to [0, size).
RowRange pixels_of(const Extent& extent, int size) {
    const auto limit = static_cast<float>(size);
    // Without the calls and branches of floor, ceil and clamp: there are thousands of patches.
    const auto within = [limit](float value) {
        const float not_below = value > 0.0F ? value : 0.0F;
        return not_below < limit ? not_below : limit;
    };
    const float end = within(extent.greatest + kMargin_px);
    const auto whole_end = static_cast<int>(end);
    return {static_cast<int>(within(extent.least - kMargin_px)),
            whole_end + static_cast<int>(static_cast<float>(whole_end) < end)};
}

bool lands_inside(const BoxReach& reach, glm::ivec2 size_px) {
    const auto inside = [](const Extent& extent, int size) {
        return extent.least >= kMargin_px && extent.greatest <= static_cast<float>(size) - kMargin_px;
    };
    return reach.kind == BoxReach::Kind::bounded && reach.greatest_depth < kGreatestDepth &&
           inside(reach.x, size_px.x) && inside(reach.y, size_px.y);
}

PixelRect joined(const PixelRect& a, const PixelRect& b) {
    if (a.empty()) return b;
    if (b.empty()) return a;
    return {glm::min(a.first_px, b.first_px), glm::max(a.end_px, b.end_px)};
}

}  // namespace

void SplatReach::build(const SplatTiles& tiles, const ObjectMatrices& matrices, glm::ivec2 target_size_px,
                       TaskPool* threads) {
    target_size_px_ = target_size_px;
    bands_ = tiles.bands();
    tiles_per_band_ = tiles.tiles_per_band();
    rects_.assign(index(bands_, 0), PixelRect{});
    cut_.assign(rects_.size(), 0);
    for_ranges(threads, static_cast<std::size_t>(bands_), kBandsPerTask, [&](std::size_t begin, std::size_t end) {
        for (std::size_t band = begin; band < end; ++band) place_band(tiles, matrices, static_cast<int>(band));
    });
}

void SplatReach::place_band(const SplatTiles& tiles, const ObjectMatrices& matrices, int band) {
    const int y = band * kBandHeight_px;
    const int end_y = std::min(y + kBandHeight_px, tiles.size_px.y);
    const auto b = static_cast<std::size_t>(band);
    for (int i = tiles.first_patch[b]; i < tiles.first_patch[b + 1]; ++i) {
        const TilePatch& patch = tiles.patches[static_cast<std::size_t>(i)];
        const PixelMatrix* matrix = matrices.find(patch.object);
        if (matrix == nullptr) continue;
        const int x = patch.tile * kTileWidth_px;
        const int end_x = std::min(x + kTileWidth_px, tiles.size_px.x);
        const BoxReach reach =
            reach_of({static_cast<float>(x) + 0.5F, static_cast<float>(end_x) - 0.5F, static_cast<float>(y) + 0.5F,
                      static_cast<float>(end_y) - 0.5F, patch.least_depth, patch.greatest_depth},
                     *matrix);
        const std::size_t tile = index(band, patch.tile);
        if (!lands_inside(reach, target_size_px_)) cut_[tile] = 1;
        if (reach.kind == BoxReach::Kind::behind) continue;
        PixelRect rect{{0, 0}, target_size_px_};
        if (reach.kind == BoxReach::Kind::bounded) {
            const RowRange columns = pixels_of(reach.x, target_size_px_.x);
            const RowRange rows = pixels_of(reach.y, target_size_px_.y);
            rect = {{columns.begin, rows.begin}, {columns.end, rows.end}};
        }
        rects_[tile] = joined(rects_[tile], rect);
    }
}

int SplatReach::tiles_outside() const {
    return static_cast<int>(std::ranges::count_if(rects_, [](const PixelRect& rect) { return rect.empty(); }));
}

}  // namespace lw
