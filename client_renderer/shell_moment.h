#pragma once
/// The time of one frame of shells: when it is drawn, and when it is shown.

#include <optional>

#include "core/camera.h"
#include "core/clock.h"
#include "core/pose.h"

namespace lw {

/// When a frame is drawn, and for which poses.
struct ShellMoment {
    double now_s = 0.0;         ///< of the run's clock, when drawing begins
    double scene_time_s = 0.0;  ///< the movers are drawn at
    TimePoint pose_sampled;     ///< stamp of the newest head sample
    Pose shown_from;            ///< the eye, or the middle of two, as the head is predicted: at the beginning, in
    Pose shown_middle;          ///< the middle and at the end of the frame's life on the display
    Pose shown_until;
    Camera source;               ///< what one main view would be drawn with: size, field of view, near plane
    double head_motion_m = 0.0;  ///< reveal_margin_m(), and from the middle of two eyes to the farther one
    /// What drawing everything with `source` would cost, for a budget of `auto`; where it is not known, what it cost at
    /// the start counts.
    std::optional<double> main_view_ms = std::nullopt;
};

}  // namespace lw
