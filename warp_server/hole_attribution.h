#pragma once
/// Which layers might have shown something in the holes of a display frame.

#include "frame_link/hole_feedback.h"
#include "warp_server/warp_method.h"

namespace lw {

/// Adds the unreached pixels of `shown` (holes or filled) to `feedback`, for every layer of the frame whose picture
/// covers their direction: estimated from every second pixel of every second row. Directions are compared as if the
/// eyes stood in one place, which is right for what is far and near enough for counting. Any thread.
void attribute_holes(const DisplayFrame& shown, const RenderedFrame& frame, const Camera& target,
                     HoleFeedback& feedback);

}  // namespace lw
