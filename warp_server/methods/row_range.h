#pragma once
/// Bands of image rows, and the same of columns.

#include <span>

namespace lw {

/// Half-open range of image rows, or columns.
struct RowRange {
    int begin = 0;
    int end = 0;
};

/// Cuts `rows` rows into `count` bands: band `index` of them, as equal as they can be.
[[nodiscard]] RowRange band_of_rows(int rows, int index, int count);

/// The first row before which all rows together cost at least `cost`. `cost_until[y]` is the cost of all rows before y,
/// one more entry than rows, ascending.
[[nodiscard]] int row_at_cost(std::span<const float> cost_until, float cost);

/// Bands of rows that cost about the same: band `index` of `count`.
[[nodiscard]] RowRange band_of_cost(std::span<const float> cost_until, int index, int count);

}  // namespace lw
