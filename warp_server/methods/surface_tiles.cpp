#include "warp_server/methods/surface_tiles.h"

#include <algorithm>
#include <bit>

#include "warp_server/methods/object_matrices.h"
#include "warp_server/methods/surface_cells.h"
#include "warp_server/methods/surface_tolerances.h"

namespace lw {

TileBuilder::TileBuilder(const SurfaceLinks& links, PreparedSurface& out)
    : links_{&links}, out_{&out}, writer_{links} {}

void TileBuilder::build(int x, int y) {
    x_ = x;
    y_ = y;
    columns_ = std::min(kTileSize, links_->size_px().x - x);
    rows_ = std::min(kTileSize, links_->size_px().y - y);
    find_planes();
    assign_whole_cells();
    for (int row = 0; row < rows_; ++row) {
        for (unsigned cells = left_over_[static_cast<std::size_t>(row)]; cells != 0; cells &= cells - 1) {
            assign_cell(std::countr_zero(cells), row);
        }
    }
    write_planes();
}

// Each plane goes through the first pixel that is on none before it.
void TileBuilder::find_planes() {
    const int pixel_columns = std::min(kPixels, links_->size_px().x - x_);
    const int pixel_rows = std::min(kPixels, links_->size_px().y - y_);
    std::array<unsigned, kPixels> free{};
    std::fill_n(free.begin(), pixel_rows, (1U << static_cast<unsigned>(pixel_columns)) - 1U);
    plane_count_ = 0;
    for (int row = 0; row < pixel_rows; ++row) {
        unsigned& in_row = free[static_cast<std::size_t>(row)];
        while (in_row != 0 && plane_count_ < kMostPlanes) {
            const int column = std::countr_zero(in_row);
            in_row &= in_row - 1;
            if (!is_usable_depth(links_->pixels().depth.at(x_ + column, y_ + row))) continue;
            TilePlane& plane = planes_[static_cast<std::size_t>(plane_count_++)];
            plane.plane = plane_at(column, row);
            plane.cells = {};
            find_members(plane);
            for (std::size_t i = 0; i < free.size(); ++i) free[i] &= ~unsigned{plane.members[i]};
        }
    }
}

// Its slopes reach as far as the surface does in the tile, so that rounding of depths hardly tilts it.
BlockPlane TileBuilder::plane_at(int column, int row) const {
    BlockPlane plane;
    plane.id = links_->pixels().object_id.at(x_ + column, y_ + row);
    plane.gradient_x = step_along(column, row, 1, 0);
    plane.gradient_y = step_along(column, row, 0, 1);
    plane.depth = links_->pixels().depth.at(x_ + column, y_ + row) - static_cast<float>(column) * plane.gradient_x -
                  static_cast<float>(row) * plane.gradient_y;
    return plane;
}

// Change of depth per pixel along one axis, from the pixel at the end of the linked ones to that at their other end.
float TileBuilder::step_along(int column, int row, int step_x, int step_y) const {
    const DepthImage& depth = links_->pixels().depth;
    const glm::ivec2 last = glm::min(links_->size_px() - 1, glm::ivec2{x_, y_} + kTileSize);
    const auto linked = [&](glm::ivec2 at) {
        return step_x != 0 ? links_->to_right(at.x, at.y) : links_->down(at.x, at.y);
    };
    const glm::ivec2 step{step_x, step_y};
    glm::ivec2 end = glm::ivec2{x_ + column, y_ + row};
    glm::ivec2 begin = end;
    int steps = 0;
    while (end.x + step.x <= last.x && end.y + step.y <= last.y && linked(end)) {
        end += step;
        ++steps;
    }
    // The pixel is the first of its plane, so there is nothing before it in the tile unless that belongs to another;
    // beside the tile there may be.
    while (steps < 2 && begin.x >= step.x && begin.y >= step.y && linked(begin - step)) {
        begin -= step;
        ++steps;
    }
    return steps == 0 ? 0.0F : (depth.at(end.x, end.y) - depth.at(begin.x, begin.y)) / static_cast<float>(steps);
}

void TileBuilder::find_members(TilePlane& plane) const {
    const int pixel_columns = std::min(kPixels, links_->size_px().x - x_);
    const int pixel_rows = std::min(kPixels, links_->size_px().y - y_);
    plane.members = {};
    plane_members(links_->pixels(),
                  {x_, y_, pixel_columns, pixel_rows, plane.plane.id, plane.plane.depth, plane.plane.gradient_x,
                   plane.plane.gradient_y, links_->tolerance(plane.plane.id, kMeetingPlanesDepthPart)},
                  plane.members.data());
    // Beyond the last column and row the last pixels count again.
    if (pixel_columns == columns_) {
        for (std::uint16_t& row : plane.members) {
            row = static_cast<std::uint16_t>(row | (row >> (columns_ - 1) & 1U) << columns_);
        }
    }
    if (pixel_rows == rows_) {
        plane.members[static_cast<std::size_t>(rows_)] = plane.members[static_cast<std::size_t>(rows_ - 1)];
    }
}

// A cell is whole on the first plane that holds all of its corners.
void TileBuilder::assign_whole_cells() {
    const unsigned all_columns = (1U << static_cast<unsigned>(columns_)) - 1U;
    left_over_ = {};
    for (std::size_t row = 0; row < static_cast<std::size_t>(rows_); ++row) {
        unsigned left_over = all_columns;
        for (int i = 0; i < plane_count_; ++i) {
            TilePlane& plane = planes_[static_cast<std::size_t>(i)];
            const unsigned both = unsigned{plane.members[row]} & plane.members[row + 1];
            for (unsigned whole = both & both >> 1U & left_over; whole != 0; whole &= whole - 1) {
                plane.cells[row] |= std::uint32_t{kAllCorners} << (4 * std::countr_zero(whole));
            }
            left_over &= ~(both & both >> 1U);
        }
        left_over_[row] = static_cast<std::uint8_t>(left_over);
    }
}

// A cell that no plane holds: curved, or surfaces meet in it.
void TileBuilder::assign_cell(int column, int row) {
    const int x = x_ + column;
    const int y = y_ + row;
    if (joins_all_corners(links_->sides(x, y))) {
        writer_.add_cell_surface(out_->patches, x, y, kAllCorners);
        return;
    }
    const CornerGroups& groups = corner_groups(links_->all_links(x, y));
    for (int i = 0; i < groups.count; ++i) {
        const std::uint8_t corners = groups.corners[static_cast<std::size_t>(i)];
        if (TilePlane* plane = plane_with(column, row, corners)) {
            plane->cells[static_cast<std::size_t>(row)] |= std::uint32_t{corners} << (4 * column);
        } else {
            writer_.add_cell_surface(corners == kAllCorners ? out_->patches : out_->edges, x, y, corners);
        }
    }
}

TileBuilder::TilePlane* TileBuilder::plane_with(int column, int row, std::uint8_t corners) {
    for (int i = 0; i < plane_count_; ++i) {
        TilePlane& plane = planes_[static_cast<std::size_t>(i)];
        const unsigned above = unsigned{plane.members[static_cast<std::size_t>(row)]} >> column & 3U;
        const unsigned below = unsigned{plane.members[static_cast<std::size_t>(row) + 1]} >> column & 3U;
        if ((corners & ~(above | below << 2U)) == 0) return &plane;
    }
    return nullptr;
}

void TileBuilder::write_planes() {
    for (int i = 0; i < plane_count_; ++i) write(planes_[static_cast<std::size_t>(i)]);
}

void TileBuilder::write(const TilePlane& plane) {
    std::uint32_t any_column = 0;
    int first_row = kTileSize;
    int last_row = -1;
    for (int row = 0; row < rows_; ++row) {
        const std::uint32_t cells = plane.cells[static_cast<std::size_t>(row)];
        if (cells == 0) continue;
        any_column |= cells;
        first_row = std::min(first_row, row);
        last_row = row;
    }
    if (any_column == 0) return;
    const int first_column = std::countr_zero(any_column) / 4;
    const int last_column = (31 - std::countl_zero(any_column)) / 4;
    SurfaceTiles& tiles = out_->tiles;
    PatchList& list = tiles.surfaces;
    writer_.add(list, x_, y_, {kTileSize, kTileSize}, plane.plane, kAllCorners);
    // Inside of the tile cells meet without overlap, because one place is in one cell: bounds only hold all of them.
    const glm::ivec2 size_px = links_->size_px();
    const auto overlap = [&](int first, int end, PatchOverlap part) {
        return first == 0 || end == kTileSize ? part : kEdgeOverlap;
    };
    const auto bounds = [&](PatchOverlap part) {
        return std::pair{
            patch_extent(x_, first_column, last_column + 1, size_px.x, overlap(first_column, last_column + 1, part)),
            patch_extent(y_, first_row, last_row + 1, size_px.y, overlap(first_row, last_row + 1, part))};
    };
    const auto [whole_columns, whole_rows] = bounds(kPatchOverlap);
    list.left.back() = whole_columns.begin;
    list.right.back() = whole_columns.end;
    list.top.back() = whole_rows.begin;
    list.bottom.back() = whole_rows.end;
    const auto [edge_columns, edge_rows] = bounds(kEdgeOverlap);
    tiles.edge_left.push_back(edge_columns.begin);
    tiles.edge_right.push_back(edge_columns.end);
    tiles.edge_top.push_back(edge_rows.begin);
    tiles.edge_bottom.push_back(edge_rows.end);
    tiles.cells.insert(tiles.cells.end(), plane.cells.begin(), plane.cells.end());
}

}  // namespace lw
