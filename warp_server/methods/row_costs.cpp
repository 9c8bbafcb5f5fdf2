#include "warp_server/methods/row_costs.h"

namespace lw {

void RowCosts::begin(int rows, float per_row) {
    per_row_ = per_row;
    entries_.assign(static_cast<std::size_t>(rows) + 1, 0.0F);
}

void RowCosts::add(RowRange rows, float cost) {
    const float of_row = cost / static_cast<float>(rows.end - rows.begin);
    entries_[static_cast<std::size_t>(rows.begin)] += of_row;
    entries_[static_cast<std::size_t>(rows.end)] -= of_row;
}

std::span<const float> RowCosts::until() {
    float of_row = per_row_;
    float until = 0.0F;
    for (float& entry : entries_) {
        of_row += entry;
        entry = until;
        until += of_row;
    }
    return entries_;
}

}  // namespace lw
