#pragma once
/// The surfaces that meet in one cell: groups of its corners, each with the plane it lies on.

#include <array>
#include <cstdint>

#include "core/object_transform.h"
#include "warp_server/methods/surface_links.h"

namespace lw {

/// Corner sets of the surfaces in a cell, as bits 1 << corner; `count` of them, in the order of their first corners.
struct CornerGroups {
    std::array<std::uint8_t, 4> corners{};
    int count = 0;
};

/// Corners that links join, directly or through others. `links` are CellLink bits. Looked up, any thread.
[[nodiscard]] const CornerGroups& corner_groups(std::uint8_t links);

/// One surface of one cell.
struct CellSurface {
    ObjectId object_id = 0;
    float depth = 0.0F;  ///< of its plane at the cell's corner 0
    float gradient_x = 0.0F;
    float gradient_y = 0.0F;
};

/// False when the group is a corner with an unusable depth.
[[nodiscard]] bool cell_surface(const SurfaceLinks& links, int x, int y, std::uint8_t corners, CellSurface& surface);

}  // namespace lw
