#pragma once
/// Which pixels of a picture need a second surface behind the first: those that a moved head may look behind.

#include "core/camera.h"
#include "core/image.h"

namespace lw {

/// For each pixel of a picture the depth at and beyond which a surface belongs to the first layer, so that a hidden
/// layer (ScenePart::behind) holds what lies behind; 0 where no head within `head_motion_m` of the camera looks behind
/// anything.
///
/// A head that moves sideways by m shifts surfaces of depths a and b against each other by
/// pixels_per_tangent * m / near_m * |a - b| pixels. A pixel is needed where that shift between its surface and a
/// farther one is at least the distance between the two in the picture. A rim of kRimPx pixels of the farther surface
/// around those is needed too: what it uncovers must join what was seen.
///
/// @param camera  of the picture; the longer pixel pitch counts
/// @param depth   of the picture, of the camera's size, reversed infinite depth; what is no depth counts as background
/// @param head_motion_m  >= 0
/// Pure, any thread.
[[nodiscard]] DepthImage hidden_limits(const Camera& camera, const DepthImage& depth, double head_motion_m);

inline constexpr int kRimPx = 2;

}  // namespace lw
