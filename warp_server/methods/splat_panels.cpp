#include "warp_server/methods/splat_panels.h"

#include <algorithm>

namespace lw {
namespace {

// A second-level cache of 1 MB. Half of it was slower: narrower panels place more points twice.
constexpr std::size_t kMostKeys = 128 * 1024;
constexpr std::size_t kMostPanels = 4;
constexpr int kLeastColumns = 4 * kTileWidth_px;

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

void SplatPanel::build(const SplatReach& reach, RowRange columns) {
    columns_ = columns;
    target_height_ = reach.target_size_px().y;
    tiles_per_band_ = reach.tiles_per_band();
    const int bands = reach.bands();
    rows_.assign(static_cast<std::size_t>(bands), RowRange{});
    outside_.assign(static_cast<std::size_t>(bands) * static_cast<std::size_t>(tiles_per_band_), 1);
    for (int band = 0; band < bands; ++band) {
        for (int tile = 0; tile < tiles_per_band_; ++tile) {
            const PixelRect& rect = reach.rect_of(band, tile);
            if (rect.empty() || rect.end_px.x <= columns.begin || rect.first_px.x >= columns.end) continue;
            outside_[static_cast<std::size_t>(band * tiles_per_band_ + tile)] = 0;
            RowRange& rows = rows_[static_cast<std::size_t>(band)];
            rows = joined(rows, {rect.first_px.y, rect.end_px.y});
        }
    }

    first_row_.assign(static_cast<std::size_t>(bands) + 1, target_height_);
    for (auto band = static_cast<std::size_t>(bands); band-- > 0;) {
        const RowRange& rows = rows_[band];
        first_row_[band] = rows.begin < rows.end ? std::min(rows.begin, first_row_[band + 1]) : first_row_[band + 1];
    }
    rows_in_flight_ = 1;
    int end = 0;
    for (std::size_t band = 0; band < rows_.size(); ++band) {
        end = std::max(end, rows_[band].end);
        rows_in_flight_ = std::max(rows_in_flight_, end - first_row_[band]);
    }
}

int SplatPanel::first_row_of_share(const SplatTiles& tiles, int index, int count) const {
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

RowRange SplatPanel::share(const SplatTiles& tiles, int index, int count) const {
    // Bands need not land in their own order (a picture upside down), so the cuts are put in order here.
    RowRange rows{0, target_height_};
    for (int i = 0; i <= index; ++i) rows.begin = std::max(rows.begin, first_row_of_share(tiles, i, count));
    rows.end = std::max(rows.begin, first_row_of_share(tiles, index + 1, count));
    return rows;
}

void SplatPanels::build(const SplatReach& reach) {
    build(reach, 1);
    while (most_keys() > kMostKeys && count_ < kMostPanels &&
           reach.target_size_px().x >= static_cast<int>(2 * count_) * kLeastColumns) {
        build(reach, 2 * count_);
    }
}

void SplatPanels::build(const SplatReach& reach, std::size_t count) {
    count_ = count;
    panels_.resize(std::max(panels_.size(), count));
    // Whole cache lines of every image: threads meet at rows alone.
    const int width = reach.target_size_px().x;
    const auto end_of = [&](std::size_t panel) {
        return panel == count
                   ? width
                   : width * static_cast<int>(panel) / static_cast<int>(count) / kTileWidth_px * kTileWidth_px;
    };
    for (std::size_t i = 0; i < count; ++i) panels_[i].build(reach, {end_of(i), end_of(i + 1)});
}

std::size_t SplatPanels::most_keys() const {
    std::size_t most = 0;
    for (const SplatPanel& panel : all()) {
        const RowRange columns = panel.columns();
        most = std::max(most, static_cast<std::size_t>(columns.end - columns.begin) *
                                  static_cast<std::size_t>(panel.rows_in_flight()));
    }
    return most;
}

}  // namespace lw
