#include "warp_server/methods/row_range.h"

#include <algorithm>

namespace lw {

RowRange band_of_rows(int rows, int index, int count) { return {rows * index / count, rows * (index + 1) / count}; }

int row_at_cost(std::span<const float> cost_until, float cost) {
    return static_cast<int>(std::lower_bound(cost_until.begin(), cost_until.end() - 1, cost) - cost_until.begin());
}

RowRange band_of_cost(std::span<const float> cost_until, int index, int count) {
    const int rows = static_cast<int>(cost_until.size()) - 1;
    const auto first_row_at = [&](int part) {
        if (part == 0) return 0;
        if (part == count) return rows;
        return row_at_cost(cost_until, cost_until.back() * static_cast<float>(part) / static_cast<float>(count));
    };
    return {first_row_at(index), first_row_at(index + 1)};
}

}  // namespace lw
