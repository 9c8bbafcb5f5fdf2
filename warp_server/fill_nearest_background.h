#pragma once
/// Fill from the nearest reached pixel along the hole's row or column, on the side that lies farther away.

#include <memory>

#include "warp_server/fill.h"

namespace lw {

/// A hole opens between a foreground edge and the background that it uncovers, so of the two ends of a row (or column)
/// of hole pixels the farther one continues it; so does the farther one of row and column. Cost grows with the holes,
/// not with the picture. Depends on this frame alone; equal frames give equal bytes.
[[nodiscard]] std::unique_ptr<Fill> make_nearest_background_fill();

}  // namespace lw
