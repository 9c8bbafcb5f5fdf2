#pragma once
/// Fill from a pyramid of averages: the farther a hole is from what was seen, the wider the average it shows.

#include <memory>

#include "warp_server/fill.h"

namespace lw {

/// Each hole pixel gets a limit, the depth of the background that its row and column end in (HoleEnds). Then pull:
/// each cell of a level averages those of its four children that the limits of its holes allow, the farthest of them
/// only, so that foreground never counts; a cell that is left with nothing is a hole of its level, under the same
/// limit. Then push, from the coarsest level down: each hole takes the bilinear mean of the cells above it, displaced
/// towards the background's side of its epipolar line. Right beside the background its closest pixel is shown as it is.
/// (Pull-push: Gortler et al., "The Lumigraph", SIGGRAPH 1996, section 3.2.3; depth limits, direction and tiles are
/// ours.) Averages stand still where copies of single pixels would crawl. Cost grows with the holes and their
/// surroundings, not with the picture. Depends on this frame alone; equal frames give equal bytes on one machine.
[[nodiscard]] std::unique_ptr<Fill> make_pyramid_fill();

}  // namespace lw
