#pragma once
/// The pixels that `splat` places together, found once per layer.

#include <cstdint>
#include <vector>

#include "core/object_transform.h"
#include "frame_link/rendered_frame.h"
#include "warp_server/pixel_rect.h"

namespace lw {

/// Pixels are looked at in blocks of 16 in one row.
inline constexpr int kBlockWidth_px = 16;

/// The pixels of one object in one block, and to which neighbours the slopes of their surface are taken
/// (one_sided_difference in splat_footprint.h). Bit i of a mask stands for the block's pixel i.
struct SplatRun {
    std::uint16_t x_px = 0;  ///< of the block's first pixel
    std::uint16_t y_px = 0;
    ObjectId object = 0;
    std::uint16_t points = 0;    ///< usable, of the object, no background of object 0
    std::uint16_t after_x = 0;   ///< slope along x: to the pixel after,
    std::uint16_t before_x = 0;  ///< or to the one before; in neither mask: 0
    std::uint16_t after_y = 0;
    std::uint16_t before_y = 0;

    /// All 16 are points of one surface: nothing needs a mask.
    [[nodiscard]] bool is_smooth() const { return (points & after_x & after_y) == 0xFFFFU; }

    bool operator==(const SplatRun&) const = default;
};

/// Usable depths of one object, background left out.
struct ObjectDepths {
    ObjectId object = 0;
    float least = 1.0F;
    float greatest = 0.0F;
};

/// Pixels of one block that are no points: bit i stands for pixel i.
struct BlockRest {
    std::uint16_t background = 0;  ///< of object 0
    std::uint16_t unusable = 0;    ///< depth is NaN or outside [0, 1]
};

/// What one look at the pixels of a tile finds. Block by block, each down its rows: neighbours of a column are placed
/// one after the other.
struct TilePixels {
    std::vector<SplatRun> smooth;
    std::vector<SplatRun> others;
    std::vector<ObjectDepths> objects;  ///< each object of the runs once
    std::vector<BlockRest> rests;       ///< of every block
};

/// Looks at the pixels of `tile`, which begins at a multiple of kBlockWidth_px. Sides of images are below 65536 px.
/// Reuses the memory of `found`.
void find_runs(const CpuPixels& pixels, const PixelRect& tile, TilePixels& found);

}  // namespace lw
