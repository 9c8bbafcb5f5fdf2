#pragma once
/// What `splat` works out once per layer: which pixels it places together, and what every tile can reach.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "frame_link/rendered_frame.h"
#include "warp_server/methods/splat_runs.h"

namespace lw {

/// 4 blocks by 16 rows are a tile, and a row of tiles is a band.
inline constexpr int kTileWidth_px = 64;
inline constexpr int kBandHeight_px = 16;

/// How many pixels of a block are background of object 0.
enum class BackgroundShare : std::uint8_t { none, some, all };

/// Which `runs` of SplatTiles are a tile's: [first, first_other) are smooth, [first_other, end) are not.
struct TileRuns {
    std::size_t first = 0;
    std::size_t first_other = 0;
    std::size_t end = 0;
};

/// The part of one object inside one tile.
struct TilePatch {
    int tile = 0;  ///< column of the tile in its band
    ObjectId object = 0;
    float least_depth = 1.0F;     ///< over its usable pixels
    float greatest_depth = 0.0F;  ///< over its usable pixels
};

/// How many pixels of the layer an object has, background left out.
struct ObjectPixels {
    std::uint64_t all = 0;
    std::uint64_t unusable = 0;  ///< of them, with a depth that is NaN or outside [0, 1]
};

/// Immutable, any thread.
struct SplatTiles final : PreparedLayer {
    glm::ivec2 size_px{0};
    int blocks_per_row = 0;
    std::vector<BackgroundShare> background;     ///< by row, blocks_per_row each
    std::vector<SplatRun> runs;                  ///< by band and tile; of a tile the smooth ones first
    std::vector<TileRuns> tile_runs;             ///< by band and tile
    std::vector<TilePatch> patches;              ///< by band
    std::vector<int> first_patch;                ///< of every band, and one more entry for the end
    std::vector<int> points;                     ///< by band and tile
    std::vector<ObjectPixels> pixels_of_object;  ///< by id, up to the largest id there is

    /// What the blocks of the pixels [begin_x, end_x) of row y hold. 0 <= begin_x < end_x <= width.
    [[nodiscard]] BackgroundShare background_in(int begin_x, int end_x, int y) const {
        const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(blocks_per_row);
        BackgroundShare all = background[row + static_cast<std::size_t>(begin_x / kBlockWidth_px)];
        for (int block = begin_x / kBlockWidth_px + 1; block * kBlockWidth_px < end_x; ++block) {
            if (background[row + static_cast<std::size_t>(block)] != all) all = BackgroundShare::some;
        }
        return all;
    }
    [[nodiscard]] int points_of(int band, int tile) const {
        return points[static_cast<std::size_t>(band * tiles_per_band() + tile)];
    }
    [[nodiscard]] const TileRuns& runs_of(int band, int tile) const {
        return tile_runs[static_cast<std::size_t>(band * tiles_per_band() + tile)];
    }
    [[nodiscard]] int bands() const { return (size_px.y + kBandHeight_px - 1) / kBandHeight_px; }
    [[nodiscard]] int tiles_per_band() const { return (size_px.x + kTileWidth_px - 1) / kTileWidth_px; }
};

/// Reads depths and ids once.
[[nodiscard]] std::shared_ptr<const SplatTiles> tiles_of(const CpuPixels& pixels);

}  // namespace lw
