#pragma once
/// The inner loops of the pyramid fill, on the widest vectors the machine has; every one gives the same bytes.

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/image.h"

namespace lw {

/// A pixel or cell that has no colour yet stores in place of its depth what it may take: -1 - limit, where limit is
/// the largest reversed depth (the nearest surface) that continues behind it.
[[nodiscard]] constexpr float hole_with_limit(float depth) { return -1.0F - depth; }
/// A cell about which nothing is known and nothing is asked.
inline constexpr float kUnknownCell = -8.0F;

/// The mean of some pixels. Colour as the square of the sRGB value in [0, 255]: close to linear light, and a square
/// root leads back.
struct FillCell {
    float red;
    float green;
    float blue;
    float depth;  ///< reversed; hole_with_limit() for a hole, kUnknownCell
};

/// One level: cell (x, y) covers the pixels [x, x+1) * 2^level by [y, y+1) * 2^level.
struct FillLevel {
    glm::ivec2 size{0};
    std::vector<FillCell> cells;
};

/// Colour and depth of the picture. Its holes hold limits, the colour to continue, and how much of it in alpha.
struct FillPixels {
    Rgba8* colour;
    float* depth;
    glm::ivec2 size_px;
};

/// Tiles are cells of this level: 8x8 pixels.
inline constexpr int kFillTileLevel = 3;
inline constexpr int kFillTile_px = 1 << kFillTileLevel;

/// Neighbouring tiles [begin, end) of one row of tiles.
struct FillTileSpan {
    int y = 0;
    int begin = 0;
    int end = 0;
};

/// A tile with holes.
struct FillTile {
    glm::ivec2 index{0};      ///< the cell of level kFillTileLevel
    glm::vec2 towards{0.0F};  ///< the background's side, in cells of the level that is asked, each part in [-1, 1]
};

/// Hole pixels [begin, end) of one row, all of one tile.
struct FillTileRun {
    int y = 0;
    int begin = 0;
    int end = 0;
    glm::vec2 towards{0.0F};  ///< as the tile's
};

/// Levels 1 to kFillTileLevel of these tiles, from the pixels. `levels[0]` is not used; levels 1 and 2 hold whole
/// tiles.
void pull_tiles(const FillPixels& pixels, std::span<const FillTileSpan> tiles, std::span<FillLevel> levels);

/// All of a coarser level.
void pull_level(const FillLevel& finer, FillLevel& coarser);

/// Holes and unknown cells of `finer` get their value from `coarser`, which has none left: all of the level.
void push_level(const FillLevel& coarser, FillLevel& finer);

/// Holes of `finer` in these tiles, whose sides hold `side` cells (1, 2 or 4).
void push_tiles(const FillLevel& coarser, std::span<const FillTile> tiles, int side, FillLevel& finer);

/// Hole pixels from level 1.
void push_pixels(const FillLevel& level1, std::span<const FillTileRun> runs, const FillPixels& pixels);

}  // namespace lw
