#include "scene/city_layout.h"

#include <algorithm>
#include <cmath>

#include "scene/random.h"

namespace lw::scene {

namespace {

/// Cuts each half of the grid (west and east of the start street) into small rectangles of blocks.
std::vector<BlockGroup> grouped(int columns, int rows, std::uint64_t seed) {
    Random random{seed, 10};
    std::vector<BlockGroup> groups;
    std::vector<bool> taken(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), false);
    const auto index = [&](int column, int row) { return static_cast<std::size_t>(row * columns + column); };
    for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
            if (taken[index(column, row)]) continue;
            BlockGroup group{column, row, 1, 1};
            const int limit = column < columns / 2 ? columns / 2 : columns;
            if (random.chance(0.4) && column + 1 < limit && !taken[index(column + 1, row)]) group.columns = 2;
            if (random.chance(0.4) && row + 1 < rows) group.rows = 2;
            for (int r = row; r < row + group.rows; ++r) {
                for (int c = column; c < column + group.columns; ++c) taken[index(c, r)] = true;
            }
            groups.push_back(group);
        }
    }
    return groups;
}

}  // namespace

CityLayout make_city_layout(int buildings, std::uint64_t seed) {
    CityLayout layout;
    const int blocks = std::max(4, (buildings + kLotsPerBlock - 1) / kLotsPerBlock);
    // About as wide as long.
    const double columns = std::sqrt(blocks * kPitchZ_m / kPitchX_m);
    layout.columns = std::max(2, 2 * static_cast<int>(columns / 2.0 + 0.4));
    layout.rows = std::max(2, (blocks + layout.columns - 1) / layout.columns);
    for (int row = 0; row < layout.rows; ++row) {
        for (int column = 0; column < layout.columns; ++column) {
            const glm::dvec3 centre{layout.street_x_m(column) + 0.5 * kPitchX_m, 0.0,
                                    layout.street_z_m(row) - 0.5 * kPitchZ_m};
            layout.blocks.push_back({column, row, centre, 0});
        }
    }
    // Houses fill the blocks nearest to the start first; what is left over is parks. The block ahead to the left is
    // a park too when there is one to spare.
    std::vector<Block*> order;
    for (Block& block : layout.blocks) order.push_back(&block);
    const glm::dvec3 start{4.0, 0.0, 0.0};
    const auto distance = [&](const Block* block) {
        return glm::dot(block->centre_m - start, block->centre_m - start);
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](const Block* a, const Block* b) { return distance(a) < distance(b); });
    const auto all = static_cast<int>(order.size()) * kLotsPerBlock;
    if (all - buildings >= kLotsPerBlock && layout.rows > 3) {
        const auto park = std::find_if(order.begin(), order.end(), [&](const Block* block) {
            return block->column == layout.columns / 2 - 1 && block->row == 2;
        });
        std::rotate(park, park + 1, order.end());
    }
    int left = buildings;
    for (Block* block : order) {
        block->houses = std::min(left, kLotsPerBlock);
        left -= block->houses;
    }
    layout.groups = grouped(layout.columns, layout.rows, seed);
    return layout;
}

}  // namespace lw::scene
