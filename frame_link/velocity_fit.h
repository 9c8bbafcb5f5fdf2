#pragma once
/// The linear and angular velocity of the head now, from the samples of the last moments.

#include <chrono>
#include <optional>
#include <span>

#include "frame_link/feeds.h"

namespace lw {

/// How far back samples count. Over the recordings of heads that this project is tested with (72-120 Hz, played at
/// 1 kHz), 30 ms predicts best at any horizon from 20 to 300 ms; 12 and 50 ms are 3-4 % worse.
inline constexpr Duration kVelocityWindow = std::chrono::milliseconds{30};

/// A velocity is believed in full for kSteadySpan, then it dies away by e over every kVelocityDecay more. Nobody turns
/// for long: over the recordings, undiminished velocity 300 ms ahead has a larger mean error than holding still.
inline constexpr Duration kSteadySpan = std::chrono::milliseconds{30};
inline constexpr Duration kVelocityDecay = std::chrono::milliseconds{80};

/// How many seconds' worth of velocity a horizon of `seconds` is: itself up to kSteadySpan and for the past, never more
/// than kSteadySpan + kVelocityDecay. Pure, any thread.
[[nodiscard]] double steady_span(double seconds);

/// A pose and how it moves on.
struct HeadMotionFit {
    PoseSample newest;                        ///< the newest usable sample
    Pose pose;                                ///< its pose, or where the others say it should be when it is a glitch
    glm::dvec3 velocity_m_per_s{0.0};         ///< world
    glm::dvec3 velocity_rad_per_s_head{0.0};  ///< rotation vector per second in the head's own frame

    /// Carried on by `seconds`, which may be negative, at a velocity that dies away (steady_span()).
    [[nodiscard]] Pose pose_after(double seconds) const;
};

/// Median of the slopes between all pairs of samples (Theil 1950, Sen 1968), per component of position and rotation
/// vector: a wild sample, the newest included, does not move it, and a uniform motion is found exactly. At least the
/// three newest samples are used, however slow the tracker, unless they are older than a quarter of a second.
/// @param samples newest first; unusable ones and those out of order are passed over. No allocation.
/// @return nothing when no sample is usable; velocity zero when only one is.
[[nodiscard]] std::optional<HeadMotionFit> fit_velocity(std::span<const PoseSample> samples);

}  // namespace lw
