#pragma once
/// The surfaces that meet in one cell: groups of its corners, each with the plane it lies on.

#include <array>
#include <cstdint>

#include "warp_server/methods/surface_classify.h"
#include "warp_server/methods/surface_patch.h"

namespace lw {

/// Corner sets of the surfaces in a cell, as bits 1 << corner; `count` of them, in the order of their first corners.
struct CornerGroups {
    std::array<std::uint8_t, 4> corners{};
    int count = 0;
};
inline constexpr std::uint8_t kAllCorners = 15;

/// Corners that links join, directly or through others. `links` are CellLink bits. Looked up, any thread.
[[nodiscard]] const CornerGroups& corner_groups(std::uint8_t links);

/// One surface of one cell. Places are relative to the cell's corner 0.
struct CellSurface {
    std::uint8_t corners = 0;
    ObjectId object_id = 0;
    SourcePlane plane;  ///< its origin is the centre of the cell
};

/// False when the group is a corner with an unusable depth.
[[nodiscard]] bool cell_surface(const CpuPixels& pixels, const PreparedSurface& prepared, int x, int y,
                                std::uint8_t corners, CellSurface& surface);

}  // namespace lw
