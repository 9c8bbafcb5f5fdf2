#pragma once
/// How far the view of a client of shells reaches beyond the display on each side: as far as the eye is expected to
/// look while it is shown, and no farther. Where the head does something else, tiles stand in.

#include "core/camera.h"
#include "core/pose.h"

namespace lw {

/// What the eye is expected to do while a view is shown.
struct ViewMotion {
    Pose drawn_from;
    Pose shown_from;
    Pose shown_until;
    double near_m = 1.0;  ///< distance of what is near, > 0: what lies there shifts most as the eye moves
};

/// Pixels of the display, whole ones, so that the grids of the two coincide.
struct ViewExtent {
    int left_px = 0;
    int right_px = 0;
    int down_px = 0;
    int up_px = 0;

    /// With so much of each side, 0 to 1.
    [[nodiscard]] ViewExtent scaled(double share) const;
    friend bool operator==(const ViewExtent&, const ViewExtent&) = default;
};

/// `display` with so much around it, at the same pixels per tangent. Pure, any thread.
[[nodiscard]] Camera extended(const Camera& display, const ViewExtent& extent);

/// What a display at any of the motion's poses shows, at the distance near_m and at infinity, as it is seen from
/// `drawn_from`. A side ends at kWidestHalfAngleRad. Pure, any thread.
[[nodiscard]] ViewExtent needed_extent(const Camera& display, const ViewMotion& motion);

/// The extent of the next view, with sides in steps of a 32nd of the display, so that the picture's size, and with it
/// the renderer's buffers, seldom change: a side grows at once, and shrinks when two steps less would do. A motion of
/// up to a pixel, as of a still head's tracker, needs nothing. Pure, any thread.
[[nodiscard]] ViewExtent next_extent(const Camera& display, const ViewMotion& motion, const ViewExtent& before);

}  // namespace lw
