#pragma once
/// A view whose two sides are drawn in turn. While the eye hardly moves a picture that is a frame older is as good, and
/// each side has the time of both.

#include <span>

#include "core/camera.h"
#include "core/pose.h"

namespace lw {

enum class ViewSide { whole, left, right };

/// Of `whole` the columns that a side has, `whole` itself for the whole. The middle belongs to both sides. Pure, any
/// thread.
/// @param other   where the picture was drawn that the other side is shown from: the side reaches as far as that shows
///                nothing, at the distance near_m and at infinity
/// @param near_m  > 0
[[nodiscard]] Camera side_of(const Camera& whole, ViewSide side, const Camera& other, double near_m);

/// Of what a display at any of `poses` shows of `whole`, the share that neither `side` nor `other` holds: directions
/// are compared as if all eyes stood in one place. Pure, any thread.
[[nodiscard]] double share_left_open(const Camera& whole, const Camera& side, const Camera& other,
                                     const Camera& display, std::span<const Pose> poses);

/// The pose as long after `to` as that is after `from`, if the head goes on as it did between the two. Pure, any
/// thread.
[[nodiscard]] Pose gone_on(const Pose& from, const Pose& to);

}  // namespace lw
