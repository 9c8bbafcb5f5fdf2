#pragma once
/// How far the eye of a warped view may be from the eye a frame is drawn for.

#include <optional>

#include "frame_link/prediction.h"

namespace lw {

/// The margin of one frame, metres: what --reveal-margin gives, or, without it, as far as the head is expected to be
/// from `drawn_from` at the beginning and at the end of the frame's life on the display, half as much again for what a
/// prediction of constant velocity cannot know, and 5 mm for a head that stands still.
/// @param given  metres, >= 0; nothing: predicted
/// @param now    when drawing begins; no later pose sample is looked at
[[nodiscard]] double reveal_margin_m(std::optional<double> given, HeadPosePredictor& predictor,
                                     const HeadPoseFeed& feed, TimePoint now, const Pose& drawn_from,
                                     TimePoint shown_from, TimePoint shown_until);

/// Whether the head is expected to move or turn by more than a sensor's noise from `now` to `shown_until`: faster than
/// 2 cm or 2 degrees a second.
[[nodiscard]] bool viewer_moves(HeadPosePredictor& predictor, const HeadPoseFeed& feed, TimePoint now,
                                TimePoint shown_until);

}  // namespace lw
