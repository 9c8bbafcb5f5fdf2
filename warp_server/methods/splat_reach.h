#pragma once
/// Where the points of every band of the source can land in the target: what lets `splat` finish target rows early,
/// leave out tiles that land outside of the picture, and share the target among threads.

#include <cstdint>
#include <span>
#include <vector>

#include "warp_server/methods/object_matrices.h"
#include "warp_server/methods/row_range.h"
#include "warp_server/methods/splat_tiles.h"

namespace lw {

/// Rebuilt for every display frame; reuses its memory.
class SplatReach {
public:
    /// Projects the corners of every patch; extents of points and rounding are allowed for.
    void build(const SplatTiles& tiles, const ObjectMatrices& matrices, glm::ivec2 target_size_px);

    /// Target rows that points of `band` can write; empty when none of it is seen. Cut to the target.
    [[nodiscard]] RowRange rows_of_band(int band) const { return rows_[static_cast<std::size_t>(band)]; }
    /// First target row that `band` or any later band can write.
    [[nodiscard]] int first_row_from_band(int band) const { return first_row_[static_cast<std::size_t>(band)]; }
    /// For each tile of `band`, 1 when no pixel of it can be seen.
    [[nodiscard]] std::span<const std::uint8_t> outside(int band) const {
        const auto count = static_cast<std::size_t>(tiles_per_band_);
        return {outside_.data() + count * static_cast<std::size_t>(band), count};
    }
    [[nodiscard]] int tiles_outside() const { return tiles_outside_; }

    /// How many target rows are in flight at most when the bands are worked on in order.
    [[nodiscard]] int rows_in_flight() const { return rows_in_flight_; }

    /// Share `index` of `count` of the target rows, of about equal work. Shares meet and cover all rows.
    [[nodiscard]] RowRange share(const SplatTiles& tiles, int index, int count) const;

private:
    [[nodiscard]] int first_row_of_share(const SplatTiles& tiles, int index, int count) const;

    int target_height_ = 0;
    int tiles_per_band_ = 0;
    int tiles_outside_ = 0;
    int rows_in_flight_ = 0;
    std::vector<RowRange> rows_;
    std::vector<int> first_row_;  // one entry more than bands: the target's height
    std::vector<std::uint8_t> outside_;
};

}  // namespace lw
