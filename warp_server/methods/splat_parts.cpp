#include "warp_server/methods/splat_parts.h"

#include <algorithm>

namespace lw {
namespace {

// A second-level cache of 1 MB. Half of it was slower: narrower panels place more points twice.
constexpr std::size_t kMostKeys = 128 * 1024;
constexpr int kMostPanels = 4;
constexpr int kLeastColumns = 4 * kTileWidth_px;

// A target pixel costs something, too, where no point lands: about a third of a point.
constexpr float kCostOfPoint = 3.0F;
constexpr float kCostOfPixel = 1.0F;

RowRange joined(const RowRange& a, const RowRange& b) {
    if (a.begin >= a.end) return b;
    if (b.begin >= b.end) return a;
    return {std::min(a.begin, b.begin), std::max(a.end, b.end)};
}

// Whole cache lines of every image: threads meet at rows alone.
RowRange columns_of_panel(int width, int index, int count) {
    const auto end_of = [&](int panel) {
        return panel == count ? width : width * panel / count / kTileWidth_px * kTileWidth_px;
    };
    return {end_of(index), end_of(index + 1)};
}

// Of several panels. Every cut between rows has tiles on both sides, which are placed twice: a fortieth of the work of
// a still head. It pays where the cost of parts is hard to tell beforehand.
int parts_for(int panels, int threads) { return threads == 1 ? panels : std::max(panels, 2 * threads); }

}  // namespace

void SplatPart::build(const SplatReach& reach, const PixelRect& rect) {
    rect_ = rect;
    tiles_per_band_ = reach.tiles_per_band();
    const int bands = reach.bands();
    rows_.assign(static_cast<std::size_t>(bands), RowRange{});
    landings_.assign(static_cast<std::size_t>(bands) * static_cast<std::size_t>(tiles_per_band_), TileLanding::outside);
    for (int band = 0; band < bands; ++band) {
        for (int tile = 0; tile < tiles_per_band_; ++tile) {
            const PixelRect reached = reach.rect_of(band, tile);
            const PixelRect here = common(reached, rect);
            if (here.empty()) continue;
            const bool inside =
                reach.lands_whole(band, tile) && here.first_px == reached.first_px && here.end_px == reached.end_px;
            landings_[static_cast<std::size_t>(band * tiles_per_band_ + tile)] =
                inside ? TileLanding::inside : TileLanding::crossing;
            RowRange& rows = rows_[static_cast<std::size_t>(band)];
            rows = joined(rows, {here.first_px.y, here.end_px.y});
        }
    }

    first_row_.assign(static_cast<std::size_t>(bands) + 1, rect.end_px.y);
    for (auto band = static_cast<std::size_t>(bands); band-- > 0;) {
        const RowRange& rows = rows_[band];
        first_row_[band] = rows.begin < rows.end ? std::min(rows.begin, first_row_[band + 1]) : first_row_[band + 1];
    }
    rows_in_flight_ = 1;
    int end = rect.first_px.y;
    for (std::size_t band = 0; band < rows_.size(); ++band) {
        end = std::max(end, rows_[band].end);
        rows_in_flight_ = std::max(rows_in_flight_, end - first_row_[band]);
    }
}

void SplatParts::build(const SplatReach& reach, const SplatTiles& tiles, int threads) {
    const int width = reach.target_size_px().x;
    const int panels = panels_for(reach);
    rects_.clear();
    bands_.clear();
    if (panels == 1) {
        balance(costs_of_rows(reach, tiles, {0, width}), width, threads);
        return;
    }
    unordered_.clear();
    costs_.clear();
    const int parts = parts_for(panels, threads);
    for (int i = 0; i < panels; ++i) {
        add_panel(reach, tiles, columns_of_panel(width, i, panels), (parts + panels - 1) / panels);
    }
    std::ranges::sort(costs_, {}, [](const Cost& cost) { return -cost.work; });
    for (const Cost& cost : costs_) rects_.push_back(unordered_[cost.rect]);
}

// What the estimate has wrong for one half of a picture it has wrong in the next.
void SplatParts::balance(std::span<const float> cost_until, int width, int threads) {
    bands_.resize(static_cast<std::size_t>(threads));
    balance_.cut(cost_until, bands_);
    for (const RowRange& rows : bands_) {
        if (rows.begin < rows.end) rects_.push_back({{0, rows.begin}, {width, rows.end}});
    }
}

void SplatParts::learn(std::span<const double> times) {
    if (!bands_.empty() && times.size() == bands_.size()) balance_.learn(times);
}

int SplatParts::panels_for(const SplatReach& reach) {
    const glm::ivec2 size_px = reach.target_size_px();
    const auto most_keys = [&](int count) {
        int most = 0;
        for (int i = 0; i < count; ++i) {
            const RowRange columns = columns_of_panel(size_px.x, i, count);
            whole_panel_.build(reach, {{columns.begin, 0}, {columns.end, size_px.y}});
            most = std::max(most, (columns.end - columns.begin) * whole_panel_.rows_in_flight());
        }
        return static_cast<std::size_t>(most);
    };
    int count = 1;
    while (count < kMostPanels && size_px.x >= 2 * count * kLeastColumns && most_keys(count) > kMostKeys) count *= 2;
    return count;
}

// The points of a tile are spread over the rows that it can reach.
std::span<const float> SplatParts::costs_of_rows(const SplatReach& reach, const SplatTiles& tiles, RowRange columns) {
    const int height = reach.target_size_px().y;
    const PixelRect panel{{columns.begin, 0}, {columns.end, height}};
    row_costs_.begin(height, kCostOfPixel * static_cast<float>(columns.end - columns.begin));
    for (int band = 0; band < reach.bands(); ++band) {
        for (int tile = 0; tile < reach.tiles_per_band(); ++tile) {
            const PixelRect here = common(reach.rect_of(band, tile), panel);
            if (here.empty()) continue;
            row_costs_.add({here.first_px.y, here.end_px.y},
                           kCostOfPoint * static_cast<float>(tiles.points_of(band, tile)));
        }
    }
    return row_costs_.until();
}

void SplatParts::add_panel(const SplatReach& reach, const SplatTiles& tiles, RowRange columns, int count) {
    const std::span<const float> cost = costs_of_rows(reach, tiles, columns);
    for (int i = 0; i < count; ++i) {
        const RowRange rows = band_of_cost(cost, i, count);
        if (rows.begin >= rows.end) continue;
        costs_.push_back(
            {cost[static_cast<std::size_t>(rows.end)] - cost[static_cast<std::size_t>(rows.begin)], unordered_.size()});
        unordered_.push_back({{columns.begin, rows.begin}, {columns.end, rows.end}});
    }
}

}  // namespace lw
