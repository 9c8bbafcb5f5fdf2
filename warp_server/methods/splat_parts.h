#pragma once
/// The order in which `splat` works: the target in parts, and in each part the bands of the source one after the other.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "warp_server/methods/band_balance.h"
#include "warp_server/methods/row_costs.h"
#include "warp_server/methods/splat_reach.h"
#include "warp_server/methods/splat_tiles.h"
#include "warp_server/pixel_rect.h"

namespace lw {

/// A rectangle of the target: which bands and tiles land there. Reuses its memory.
class SplatPart {
public:
    /// @param rect  of the target, not empty
    void build(const SplatReach& reach, const PixelRect& rect);

    [[nodiscard]] const PixelRect& rect() const { return rect_; }
    /// Rows of the rectangle that points of `band` can write; empty when none of it is seen here.
    [[nodiscard]] RowRange rows_of_band(int band) const { return rows_[static_cast<std::size_t>(band)]; }
    /// First row of the rectangle that `band` or any later band can write; its end when there is none.
    [[nodiscard]] int first_row_from_band(int band) const { return first_row_[static_cast<std::size_t>(band)]; }
    /// For each tile of `band` where its points land.
    [[nodiscard]] std::span<const TileLanding> landings(int band) const {
        const auto count = static_cast<std::size_t>(tiles_per_band_);
        return {landings_.data() + count * static_cast<std::size_t>(band), count};
    }

    /// How many rows are in flight at most when the bands are worked on in order.
    [[nodiscard]] int rows_in_flight() const { return rows_in_flight_; }

private:
    PixelRect rect_;
    int tiles_per_band_ = 0;
    int rows_in_flight_ = 0;
    std::vector<RowRange> rows_;
    std::vector<int> first_row_;  // one entry more than bands
    std::vector<TileLanding> landings_;
};

/// The parts of one display frame: rectangles that meet and cover the target, the most expensive first.
///
/// Columns: one panel is best while rows of the source stay rows of the target. Where the head turns sideways they
/// bend, a band reaches over hundreds of rows, and the keys in flight no longer fit the cache. Narrower panels have
/// fewer rows in flight, each of fewer keys; what lands across their border is placed twice. On one thread a turn of 30
/// degrees takes four fifths of the time of one panel, small turns the same.
///
/// Rows: for several threads, panels are cut where half of their work is done, and so on. Threads take parts as they
/// come free. A single panel has a part for each thread, whose shares of the work are learnt.
class SplatParts {
public:
    void build(const SplatReach& reach, const SplatTiles& tiles, int threads);

    [[nodiscard]] std::span<const PixelRect> all() const { return rects_; }

    /// What each of all() took, in any unit.
    void learn(std::span<const double> times);

private:
    [[nodiscard]] int panels_for(const SplatReach& reach);
    void add_panel(const SplatReach& reach, const SplatTiles& tiles, RowRange columns, int count);
    [[nodiscard]] std::span<const float> costs_of_rows(const SplatReach& reach, const SplatTiles& tiles,
                                                       RowRange columns);
    void balance(std::span<const float> cost_until, int width, int threads);

    struct Cost {
        float work;
        std::size_t rect;
    };
    SplatPart whole_panel_;
    std::vector<PixelRect> rects_;
    std::vector<PixelRect> unordered_;
    std::vector<Cost> costs_;
    RowCosts row_costs_;  // of a panel
    BandBalance balance_;
    std::vector<RowRange> bands_;  // of a single panel
};

}  // namespace lw
