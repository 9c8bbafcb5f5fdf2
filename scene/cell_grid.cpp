#include "scene/cell_grid.h"

#include <algorithm>
#include <cmath>

namespace lw::scene {

namespace {

/// The largest rectangle of ones in a square image of kCells, by the stack of rising columns over each row.
struct Rectangle {
    int x0 = 0;
    int x1 = -1;
    int y0 = 0;
    int y1 = -1;
    [[nodiscard]] int area() const { return (x1 - x0 + 1) * (y1 - y0 + 1); }
};

Rectangle largest_rectangle(const std::vector<std::uint8_t>& ones) {
    constexpr int kCells = CellGrid::kCells;
    std::array<int, kCells + 1> heights{};
    Rectangle best;
    for (int y = 0; y < kCells; ++y) {
        for (int x = 0; x < kCells; ++x) {
            int& height = heights[static_cast<std::size_t>(x)];
            height = ones[static_cast<std::size_t>(y * kCells + x)] != 0 ? height + 1 : 0;
        }
        std::array<int, kCells + 1> stack{};
        int depth = 0;
        for (int x = 0; x <= kCells; ++x) {
            const int height = x < kCells ? heights[static_cast<std::size_t>(x)] : 0;
            while (depth > 0 &&
                   heights[static_cast<std::size_t>(stack[static_cast<std::size_t>(depth - 1)])] >= height) {
                const int top = heights[static_cast<std::size_t>(stack[static_cast<std::size_t>(--depth)])];
                const int x0 = depth > 0 ? stack[static_cast<std::size_t>(depth - 1)] + 1 : 0;
                const Rectangle candidate{x0, x - 1, y - top + 1, y};
                if (top > 0 && candidate.area() > best.area()) best = candidate;
            }
            stack[static_cast<std::size_t>(depth++)] = x;
        }
    }
    return best;
}

}  // namespace

CellGrid::CellGrid(const Bounds& bounds)
    : bounds_{bounds},
      cell_size_{(bounds.max - bounds.min) / static_cast<double>(kCells)},
      surface_(static_cast<std::size_t>(cell_count()), 0),
      solid_(surface_.size(), 0) {}

void CellGrid::mark(const std::array<glm::dvec3, 3>& triangle) {
    std::array<glm::dvec3, 3> cells;
    for (std::size_t i = 0; i < 3; ++i) cells[i] = (triangle[i] - bounds_.min) / cell_size_;
    mark_small(cells);
}

void CellGrid::mark_small(const std::array<glm::dvec3, 3>& cell_triangle) {
    const auto& [a, b, c] = cell_triangle;
    const glm::dvec3 low = glm::min(a, glm::min(b, c));
    const glm::dvec3 high = glm::max(a, glm::max(b, c));
    const glm::dvec3 extent = high - low;
    // A triangle that is thin on one axis is flat there: its box is tight. Others are halved until half a cell large.
    const int large = (extent.x > 0.5 ? 1 : 0) + (extent.y > 0.5 ? 1 : 0) + (extent.z > 0.5 ? 1 : 0);
    if (large >= 2) {
        const double ab = glm::dot(b - a, b - a);
        const double bc = glm::dot(c - b, c - b);
        const double ca = glm::dot(a - c, a - c);
        if (ab >= bc && ab >= ca) {
            mark_small({a, 0.5 * (a + b), c});
            mark_small({0.5 * (a + b), b, c});
        } else if (bc >= ca) {
            mark_small({a, b, 0.5 * (b + c)});
            mark_small({a, 0.5 * (b + c), c});
        } else {
            mark_small({a, b, 0.5 * (c + a)});
            mark_small({0.5 * (c + a), b, c});
        }
        return;
    }
    const glm::ivec3 first = glm::clamp(glm::ivec3{glm::floor(low - 1e-6)}, 0, kCells - 1);
    const glm::ivec3 last = glm::clamp(glm::ivec3{glm::floor(high + 1e-6)}, 0, kCells - 1);
    for (int z = first.z; z <= last.z; ++z) {
        for (int y = first.y; y <= last.y; ++y) {
            for (int x = first.x; x <= last.x; ++x) surface_[index(x, y, z)] = 1;
        }
    }
}

void CellGrid::find_solid(unsigned open_sides) {
    for (std::size_t i = 0; i < solid_.size(); ++i) solid_[i] = surface_[i] != 0 ? 0 : 1;
    std::vector<glm::ivec3> outside;
    const auto reach = [&](const glm::ivec3& cell) {
        std::uint8_t& solid = solid_[index(cell.x, cell.y, cell.z)];
        if (solid == 0) return;
        solid = 0;
        outside.push_back(cell);
    };
    for (int side = 0; side < 6; ++side) {
        if ((open_sides >> side & 1U) != 0) continue;
        for (int i = 0; i < kCells; ++i) {
            for (int j = 0; j < kCells; ++j) {
                glm::ivec3 cell{0};
                cell[side / 2] = side % 2 == 1 ? kCells - 1 : 0;
                cell[(side / 2 + 1) % 3] = i;
                cell[(side / 2 + 2) % 3] = j;
                reach(cell);
            }
        }
    }
    while (!outside.empty()) {
        const glm::ivec3 cell = outside.back();
        outside.pop_back();
        for (int axis = 0; axis < 3; ++axis) {
            for (const int step : {-1, 1}) {
                glm::ivec3 next = cell;
                next[axis] += step;
                if (next[axis] >= 0 && next[axis] < kCells) reach(next);
            }
        }
    }
}

double CellGrid::solid_count() const {
    return static_cast<double>(std::count(solid_.begin(), solid_.end(), std::uint8_t{1}));
}

CellBox CellGrid::take_largest_solid_box() {
    CellBox best;
    std::vector<std::uint8_t> common(static_cast<std::size_t>(kCells * kCells));
    for (int first = 0; first < kCells; ++first) {
        std::fill(common.begin(), common.end(), std::uint8_t{1});
        for (int last = first; last < kCells; ++last) {
            for (std::size_t i = 0; i < common.size(); ++i) common[i] &= solid_[index(0, 0, last) + i];
            const Rectangle rectangle = largest_rectangle(common);
            const CellBox candidate{{rectangle.x0, rectangle.y0, first}, {rectangle.x1, rectangle.y1, last}};
            // However many more layers there are, they have no more than this in common.
            if (rectangle.area() * (kCells - first) <= best.count()) break;
            if (candidate.count() > best.count()) best = candidate;
        }
    }
    for (int z = best.first.z; z <= best.last.z; ++z) {
        for (int y = best.first.y; y <= best.last.y; ++y) {
            for (int x = best.first.x; x <= best.last.x; ++x) solid_[index(x, y, z)] = 0;
        }
    }
    return best;
}

Bounds CellGrid::bounds_of(const CellBox& cells) const {
    Bounds bounds;
    bounds.min = bounds_.min + glm::dvec3{cells.first} * cell_size_;
    bounds.max = bounds_.min + glm::dvec3{cells.last + 1} * cell_size_;
    return bounds;
}

}  // namespace lw::scene
