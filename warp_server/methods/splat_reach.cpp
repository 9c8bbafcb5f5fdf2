#include "warp_server/methods/splat_reach.h"

#include <algorithm>
#include <cmath>

#include "warp_server/methods/row_range.h"
#include "warp_server/methods/splat_footprint.h"

namespace lw {
namespace {

// Beyond a point's largest extent: the rounding of its place, which stays below 0.1 px while w is no small difference
// of large terms (see kLeastPartOfW).
constexpr float kMargin_px = kLargestHalfExtentPx + 1.0F;
constexpr float kLeastPartOfW = 1e-3F;

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
};

// Places are quotients of affine functions of x, y and depth. Where the divisor stays positive, such a quotient is
// monotone along every edge of the box, so it is bounded by its values at the corners.
BoxReach reach_of(const Box& box, const PixelMatrix& m) {
    float x[8];
    float y[8];
    float w[8];
    float size_of_w[8];
    for (int i = 0; i < 8; ++i) {
        const float at_x = (i & 1) != 0 ? box.end_x : box.begin_x;
        const float at_y = (i & 2) != 0 ? box.end_y : box.begin_y;
        const float depth = (i & 4) != 0 ? box.greatest_depth : box.least_depth;
        x[i] = m.one.x + at_y * m.y.x + at_x * m.x.x + depth * m.z.x;
        y[i] = m.one.y + at_y * m.y.y + at_x * m.x.y + depth * m.z.y;
        w[i] = m.one.w + at_y * m.y.w + at_x * m.x.w + depth * m.z.w;
        size_of_w[i] = std::abs(m.one.w) + std::abs(at_y * m.y.w) + std::abs(at_x * m.x.w) + std::abs(depth * m.z.w);
    }
    if (std::all_of(w, w + 8, [](float value) { return value <= 0.0F; })) return {BoxReach::Kind::behind, {}, {}};
    BoxReach reach{BoxReach::Kind::bounded, {1e9F, -1e9F}, {1e9F, -1e9F}};
    for (int i = 0; i < 8; ++i) {
        if (!(w[i] > kLeastPartOfW * size_of_w[i])) return {};
        reach.x = {std::min(reach.x.least, x[i] / w[i]), std::max(reach.x.greatest, x[i] / w[i])};
        reach.y = {std::min(reach.y.least, y[i] / w[i]), std::max(reach.y.greatest, y[i] / w[i])};
    }
    return reach;
}

// Pixels whose centres may lie in the extent, cut to [0, size).
RowRange pixels_of(const Extent& extent, int size) {
    const auto limit = static_cast<float>(size);
    const float begin = std::clamp(std::floor(extent.least - kMargin_px), 0.0F, limit);
    const float end = std::clamp(std::ceil(extent.greatest + kMargin_px), 0.0F, limit);
    return {static_cast<int>(begin), static_cast<int>(end)};
}

bool lands_inside(const BoxReach& reach, glm::ivec2 size_px) {
    const auto inside = [](const Extent& extent, int size) {
        return extent.least >= kMargin_px && extent.greatest <= static_cast<float>(size) - kMargin_px;
    };
    return reach.kind == BoxReach::Kind::bounded && inside(reach.x, size_px.x) && inside(reach.y, size_px.y);
}

PixelRect joined(const PixelRect& a, const PixelRect& b) {
    if (a.empty()) return b;
    if (b.empty()) return a;
    return {glm::min(a.first_px, b.first_px), glm::max(a.end_px, b.end_px)};
}

}  // namespace

void SplatReach::build(const SplatTiles& tiles, const ObjectMatrices& matrices, glm::ivec2 target_size_px) {
    target_size_px_ = target_size_px;
    bands_ = tiles.bands();
    tiles_per_band_ = tiles.tiles_per_band();
    rects_.assign(index(bands_, 0), PixelRect{});
    cut_.assign(rects_.size(), 0);
    for (int band = 0; band < bands_; ++band) {
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
            if (!lands_inside(reach, target_size_px)) cut_[tile] = 1;
            if (reach.kind == BoxReach::Kind::behind) continue;
            PixelRect rect{{0, 0}, target_size_px};
            if (reach.kind == BoxReach::Kind::bounded) {
                const RowRange columns = pixels_of(reach.x, target_size_px.x);
                const RowRange rows = pixels_of(reach.y, target_size_px.y);
                rect = {{columns.begin, rows.begin}, {columns.end, rows.end}};
            }
            rects_[tile] = joined(rects_[tile], rect);
        }
    }
}

int SplatReach::tiles_outside() const {
    return static_cast<int>(std::ranges::count_if(rects_, [](const PixelRect& rect) { return rect.empty(); }));
}

}  // namespace lw
