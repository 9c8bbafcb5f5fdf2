#pragma once
/// Stereo as taught before there were depth warps: the other eye's picture by shifting pixels along their rows (seed
/// document 004, p. 52). A baseline of --stereo, not one of the warp methods: it follows no head and no mover.

#include <memory>

#include "core/camera.h"
#include "core/result.h"
#include "warp_server/warp_method.h"

namespace lw {

/// Shifts every pixel of the source along its row to where the eye beside sees it; rows in the order in which nearer
/// pixels overwrite farther ones, from right to left for an eye on the left. On a screen plane at distance z0,
///     x_target = x_source + (b / pixel width) * z / (z + z0),
/// with b the target eye's x minus the source eye's x and z the distance behind the plane. Whole pixels only; pixels
/// that nothing was shifted to are holes. Colour as it is: nothing is filtered. Bad depths are counted and skipped.
/// @param source, target  rectified to each other (why_not_rectified() is empty), programmer errors otherwise. The
///                        widths of their pictures may differ
void shift_rows(const CpuPixels& pixels, const Camera& source, const Camera& target, DisplayFrame& out,
                WarpCounters& counters);

/// shift_rows() as a warp method: whatever pose it is asked for, the target stands `source_from_target` from where the
/// layer was drawn.
/// @return an error when the two are not side by side
[[nodiscard]] Result<std::unique_ptr<WarpMethod>> make_scanline_method(const Camera& source, const Camera& target);

}  // namespace lw
