#pragma once
/// Resampling a whole layer through one homography: what `stale` and `rotation` do.

#include <glm/glm.hpp>

#include "warp_server/warp_method.h"

namespace lw {

/// Shows `layer` through the rotation and field of view of `target` as if both eyes stood in one place; positions are
/// ignored. Colour is bilinear in linear light, depth comes from the nearest source pixel. Target pixels whose centre
/// falls outside the source image, or behind it, are holes. A homography that moves nothing copies the source.
/// Counts bad depths of the pixels it shows and gives them depth 0.
void resample_by_rotation(const Layer& layer, const Camera& target, DisplayFrame& out, WarpCounters& counters);

}  // namespace lw
