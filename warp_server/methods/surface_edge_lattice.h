#pragma once
/// What edges show between pixels: how much of a pixel's area each surface of a cell covers wherever in the cell the
/// pixel lies, and in which colour.

#include <cstdint>

#include "warp_server/methods/surface_classify.h"
#include "warp_server/methods/surface_quarters.h"

namespace lw {

/// Of a surface in an edge cell the values at the cell's four corners and half a pixel between them, kEdgeNodes in a
/// row: the mean over a pixel's area around each node. Rows follow each other within a channel, then come the channels:
/// red, green and blue times share, and the share, all of kLinearOne.
inline constexpr int kEdgeNodes = 3;
inline constexpr int kEdgeChannel = kEdgeNodes * kEdgeNodes;
inline constexpr int kEdgeShareChannel = 3;
inline constexpr int kEdgeValues = 4 * kEdgeChannel;

/// Numbers the edge cells of `prepared`, those in its tiles too, and makes the values of each. What a pixel's own
/// surface lacks in a quarter is the other surfaces' of the cell.
void make_edge_lattices(const QuarterParts& parts, PreparedSurface& prepared);

}  // namespace lw
