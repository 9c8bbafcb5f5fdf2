#pragma once
/// The order in which `splat` works: panels, parts of the target from top to bottom, and in each the bands of the
/// source one after the other.

#include <cstdint>
#include <span>
#include <vector>

#include "warp_server/methods/row_range.h"
#include "warp_server/methods/splat_reach.h"
#include "warp_server/methods/splat_tiles.h"

namespace lw {

/// Some columns of the target: which bands and tiles land there. Reuses its memory.
class SplatPanel {
public:
    /// @param columns  of the target
    void build(const SplatReach& reach, RowRange columns);

    [[nodiscard]] RowRange columns() const { return columns_; }
    /// Target rows that points of `band` can write; empty when none of it is seen here. Cut to the target.
    [[nodiscard]] RowRange rows_of_band(int band) const { return rows_[static_cast<std::size_t>(band)]; }
    /// First target row that `band` or any later band can write.
    [[nodiscard]] int first_row_from_band(int band) const { return first_row_[static_cast<std::size_t>(band)]; }
    /// For each tile of `band`, 1 when no pixel of it can be seen here.
    [[nodiscard]] std::span<const std::uint8_t> outside(int band) const {
        const auto count = static_cast<std::size_t>(tiles_per_band_);
        return {outside_.data() + count * static_cast<std::size_t>(band), count};
    }

    /// How many target rows are in flight at most when the bands are worked on in order.
    [[nodiscard]] int rows_in_flight() const { return rows_in_flight_; }

    /// Share `index` of `count` of the target rows, of about equal work. Shares meet and cover all rows.
    [[nodiscard]] RowRange share(const SplatTiles& tiles, int index, int count) const;

private:
    [[nodiscard]] int first_row_of_share(const SplatTiles& tiles, int index, int count) const;

    RowRange columns_;
    int target_height_ = 0;
    int tiles_per_band_ = 0;
    int rows_in_flight_ = 0;
    std::vector<RowRange> rows_;
    std::vector<int> first_row_;  // one entry more than bands: the target's height
    std::vector<std::uint8_t> outside_;
};

/// The panels of one display frame. One is best while rows of the source stay rows of the target. Where the head turns
/// sideways they bend, a band reaches over hundreds of rows, and the keys in flight no longer fit the cache. Narrower
/// panels have fewer rows in flight, each of fewer keys; what lands across their border is placed twice. On one thread
/// a turn of 30 degrees takes four fifths of the time of one panel, small turns the same.
class SplatPanels {
public:
    void build(const SplatReach& reach);

    [[nodiscard]] std::span<const SplatPanel> all() const { return {panels_.data(), count_}; }

private:
    void build(const SplatReach& reach, std::size_t count);
    [[nodiscard]] std::size_t most_keys() const;

    std::size_t count_ = 0;
    std::vector<SplatPanel> panels_;  // the first count_ of them
};

}  // namespace lw
