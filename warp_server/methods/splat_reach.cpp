#include "warp_server/methods/splat_reach.h"

#include <algorithm>
#include <cmath>

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

// A pixel costs something, too, where no point lands: about a third of one with a point (what evens out the samples of
// two threads over a picture half of which is background).
long cost_of_band(const SplatTiles& tiles, std::size_t band) {
    const int rows = std::min(kBandHeight_px, tiles.size_px.y - static_cast<int>(band) * kBandHeight_px);
    return 2L * tiles.points[band] + long{rows} * tiles.size_px.x;
}

RowRange joined(const RowRange& a, const RowRange& b) {
    if (a.begin >= a.end) return b;
    if (b.begin >= b.end) return a;
    return {std::min(a.begin, b.begin), std::max(a.end, b.end)};
}

}  // namespace

void SplatReach::build(const SplatTiles& tiles, const ObjectMatrices& matrices, glm::ivec2 target_size_px) {
    const auto bands = static_cast<std::size_t>(tiles.bands());
    target_height_ = target_size_px.y;
    tiles_per_band_ = tiles.tiles_per_band();
    rows_.assign(bands, RowRange{});
    outside_.assign(bands * static_cast<std::size_t>(tiles_per_band_), 1);
    for (std::size_t band = 0; band < bands; ++band) {
        const int y = static_cast<int>(band) * kBandHeight_px;
        const int end_y = std::min(y + kBandHeight_px, tiles.size_px.y);
        std::uint8_t* outside = outside_.data() + band * static_cast<std::size_t>(tiles_per_band_);
        for (int i = tiles.first_patch[band]; i < tiles.first_patch[band + 1]; ++i) {
            const TilePatch& patch = tiles.patches[static_cast<std::size_t>(i)];
            const PixelMatrix* matrix = matrices.find(patch.object);
            if (matrix == nullptr) continue;
            const int x = patch.tile * kTileWidth_px;
            const int end_x = std::min(x + kTileWidth_px, tiles.size_px.x);
            const BoxReach reach =
                reach_of({static_cast<float>(x) + 0.5F, static_cast<float>(end_x) - 0.5F, static_cast<float>(y) + 0.5F,
                          static_cast<float>(end_y) - 0.5F, patch.least_depth, patch.greatest_depth},
                         *matrix);
            if (reach.kind == BoxReach::Kind::behind) continue;
            RowRange rows{0, target_size_px.y};
            if (reach.kind == BoxReach::Kind::bounded) {
                const RowRange columns = pixels_of(reach.x, target_size_px.x);
                rows = pixels_of(reach.y, target_size_px.y);
                if (columns.begin >= columns.end || rows.begin >= rows.end) continue;
            }
            outside[patch.tile] = 0;
            rows_[band] = joined(rows_[band], rows);
        }
    }
    tiles_outside_ = static_cast<int>(std::count(outside_.begin(), outside_.end(), 1));

    first_row_.assign(bands + 1, target_height_);
    for (std::size_t band = bands; band-- > 0;) {
        const RowRange& rows = rows_[band];
        first_row_[band] = rows.begin < rows.end ? std::min(rows.begin, first_row_[band + 1]) : first_row_[band + 1];
    }
    rows_in_flight_ = 1;
    int end = 0;
    for (std::size_t band = 0; band < bands; ++band) {
        end = std::max(end, rows_[band].end);
        rows_in_flight_ = std::max(rows_in_flight_, end - first_row_[band]);
    }
}

int SplatReach::first_row_of_share(const SplatTiles& tiles, int index, int count) const {
    if (index == 0) return 0;
    if (index == count) return target_height_;
    long total = 0;
    for (std::size_t i = 0; i < tiles.points.size(); ++i) total += cost_of_band(tiles, i);
    const long wanted = total * index / count;
    std::size_t band = 0;
    long before = 0;
    while (band + 1 < tiles.points.size() && before + cost_of_band(tiles, band) < wanted) {
        before += cost_of_band(tiles, band++);
    }
    const RowRange& rows = rows_[band];
    if (rows.begin >= rows.end) return target_height_ * index / count;
    return rows.begin + static_cast<int>((wanted - before) * (rows.end - rows.begin) / cost_of_band(tiles, band));
}

RowRange SplatReach::share(const SplatTiles& tiles, int index, int count) const {
    // Bands need not land in their own order (a picture upside down), so the cuts are put in order here.
    RowRange rows{0, target_height_};
    for (int i = 0; i <= index; ++i) rows.begin = std::max(rows.begin, first_row_of_share(tiles, i, count));
    rows.end = std::max(rows.begin, first_row_of_share(tiles, index + 1, count));
    return rows;
}

}  // namespace lw
