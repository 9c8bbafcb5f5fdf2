#pragma once
/// Double exponential smoothing of a head's pose: a light filter that knows a level and a trend.

#include <optional>

#include "frame_link/head_sample_stream.h"

namespace lw {

/// Smoothing and smoothing again leaves one and two lags behind a steady motion: their difference is its velocity, and
/// twice the first less the second its place (Brown 1956; for head and hand tracking LaViola, "Double exponential
/// smoothing: an alternative to Kalman filter-based predictive tracking", 2003). Orientations are smoothed along the
/// sphere's great arcs. One thread; no allocation.
class DoubleExponential {
public:
    /// The next sample of a stream, later than the one before.
    void add(const SoundSample& sample);

    [[nodiscard]] const std::optional<SoundSample>& newest() const { return newest_; }

    /// The pose this long after the newest sample (programmer error without one); the velocity decays with the horizon
    /// (steady_span()).
    [[nodiscard]] Pose pose_after(Duration ahead) const;

    /// Time constant of one smoothing. Over the recordings, 20 and 40 ms ahead, 8 and 16 ms are worse.
    static constexpr double kSmoothing_s = 0.012;

private:
    Pose once_;
    Pose twice_;
    double lag_s_ = kSmoothing_s;  ///< of one smoothing, behind a steady motion
    std::optional<SoundSample> newest_;
};

}  // namespace lw
