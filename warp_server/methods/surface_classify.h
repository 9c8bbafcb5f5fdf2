#pragma once
/// What `surface` works out about a layer once, before it is published: which neighbouring pixels lie on one surface,
/// and which tiles are one plane of one object.

#include <cstdint>
#include <vector>

#include "core/image.h"
#include "frame_link/rendered_frame.h"

namespace lw {

/// A cell is the unit square between the centres of four neighbouring pixels; its corners are numbered 0 (x, y),
/// 1 (x + 1, y), 2 (x, y + 1), 3 (x + 1, y + 1). Each side and diagonal may be a link: both ends on one surface.
enum CellLink : std::uint8_t {
    kLinkTop = 1,       ///< corners 0-1
    kLinkBottom = 2,    ///< 2-3
    kLinkLeft = 4,      ///< 0-2
    kLinkRight = 8,     ///< 1-3
    kLinkFalling = 16,  ///< 0-3
    kLinkRising = 32,   ///< 1-2
};
inline constexpr std::uint8_t kAllSides = kLinkTop | kLinkBottom | kLinkLeft | kLinkRight;

enum class TileKind : std::uint8_t {
    plane,  ///< one plane of one object (or background): one homography moves it
    cells,  ///< anything else: every cell is looked at
};

/// A square of kTileCells x kTileCells cells, fewer at the right and bottom.
struct SurfaceTile {
    TileKind kind = TileKind::cells;
    std::uint16_t object_id = 0;
    float depth = 0.0F;       ///< of the plane at the centre of the tile's first pixel
    float gradient_x = 0.0F;  ///< depth per pixel
    float gradient_y = 0.0F;
};
inline constexpr int kTileCells = 8;

struct PreparedSurface final : PreparedLayer {
    glm::ivec2 size_px{0};
    glm::ivec2 tiles{0};             ///< tile columns and rows
    std::vector<SurfaceTile> tile;   ///< row by row
    Image<std::uint8_t> cell_links;  ///< CellLink bits of the cell whose corner 0 is the pixel; at the last column
                                     ///< and row the missing corners count as copies of the last pixels

    [[nodiscard]] const SurfaceTile& tile_at(int column, int row) const {
        return tile[static_cast<std::size_t>(row) * static_cast<std::size_t>(tiles.x) +
                    static_cast<std::size_t>(column)];
    }
};

/// Any thread. `pixels` may hold bad depths: they are linked to nothing.
[[nodiscard]] std::shared_ptr<const PreparedSurface> classify_surfaces(const CpuPixels& pixels);

/// Depths `before, a, b, after` along a line: do a and b lie on one surface? Their difference must be small, or
/// continue the slope on one side: depth is affine in the pixel coordinates on every plane, at any slant.
[[nodiscard]] bool on_one_surface(float before, float a, float b, float after);

}  // namespace lw
