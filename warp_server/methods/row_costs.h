#pragma once
/// What the rows of a picture cost to draw, so that threads can share them out.

#include <span>
#include <vector>

#include "warp_server/methods/row_range.h"

namespace lw {

/// Keeps its memory. One thread.
class RowCosts {
public:
    /// @param per_row  what each of `rows` rows costs by itself
    void begin(int rows, float per_row);
    /// Spreads `cost` evenly over `rows`, which lie within the picture; at least one.
    void add(RowRange rows, float cost);
    /// After the last add(), once until begin(): the cost of all rows before each row and, last, of all; what
    /// band_of_cost() takes. Valid until begin().
    [[nodiscard]] std::span<const float> until();

private:
    float per_row_ = 0.0F;
    std::vector<float> entries_;  // first by how much rows cost more than the one before
};

}  // namespace lw
