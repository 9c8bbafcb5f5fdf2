#include "frame_link/double_exponential.h"

#include <cmath>

#include "core/check.h"
#include "frame_link/velocity_fit.h"

namespace lw {

void DoubleExponential::add(const SoundSample& sample) {
    if (!newest_ || sample.restarts) {
        once_ = twice_ = sample.world_from_head;
        lag_s_ = kSmoothing_s;
    } else {
        const double step_s = to_seconds(sample.time - newest_->time);
        const double share = 1.0 - std::exp(-step_s / kSmoothing_s);
        once_ = interpolate(once_, sample.world_from_head, share);
        twice_ = interpolate(twice_, once_, share);
        lag_s_ = step_s * (1.0 - share) / share;
    }
    newest_ = sample;
}

Pose DoubleExponential::pose_after(Duration ahead) const {
    LW_CHECK(newest_.has_value(), "a smoothing without a sample");
    // From twice smoothed to once is one lag; the head itself is one lag farther.
    const double lags = 2.0 + steady_span(to_seconds(ahead)) / lag_s_;
    return interpolate(twice_, once_, lags);
}

}  // namespace lw
