#pragma once
/// Squares in which surfaces meet: most are a few planes, whose cells can be drawn together.

#include <array>
#include <cstdint>

#include "warp_server/methods/surface_writer.h"

namespace lw {

/// Finds the planes of tiles. One thread at a time.
class TileBuilder {
public:
    /// Adds to `out`; both outlive this.
    TileBuilder(const SurfaceLinks& links, PreparedSurface& out);

    /// Adds the tile whose first cell is (x, y): its planes to the tiles, cells on none of them one by one.
    void build(int x, int y);

private:
    static constexpr int kPixels = kTileSize + 1;  // cells have corners on both sides
    static constexpr int kMostPlanes = 6;  // a tile with more is foliage, whose cells lie on planes of their own

    struct TilePlane {
        BlockPlane plane;
        std::array<std::uint16_t, kPixels> members{};  // rows of pixels, bit = column
        std::array<std::uint32_t, kTileSize> cells{};  // as SurfaceTiles has them
    };

    void find_planes();
    [[nodiscard]] BlockPlane plane_at(int column, int row) const;
    [[nodiscard]] float step_along(int column, int row, int step_x, int step_y) const;
    void find_members(TilePlane& plane) const;
    void assign_whole_cells();
    void assign_cell(int column, int row);
    [[nodiscard]] TilePlane* plane_with(int column, int row, std::uint8_t corners);
    void write_planes();
    void write(const TilePlane& plane);

    const SurfaceLinks* links_;
    PreparedSurface* out_;
    PatchWriter writer_;
    int x_ = 0;
    int y_ = 0;
    int columns_ = 0;  // cells in the tile: fewer at the image's end
    int rows_ = 0;
    int plane_count_ = 0;
    std::array<TilePlane, kMostPlanes> planes_;
    std::array<std::uint8_t, kTileSize> left_over_{};  // rows of cells that no plane holds wholly
};

}  // namespace lw
