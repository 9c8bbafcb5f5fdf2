#pragma once
/// Head-pose prediction from the newest samples; the client and the server use the same one.

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "frame_link/feeds.h"

namespace lw {

/// A predicted pose and the sample it rests on.
struct PredictedPose {
    Pose world_from_head;
    TimePoint newest_sample;  ///< stamp of the newest sample used: motion-to-photon counts from here
    std::uint64_t sample_number = 0;
};

/// Keeps only what it reads from the feed, so one predictor belongs to one thread.
class HeadPosePredictor {
public:
    virtual ~HeadPosePredictor() = default;
    /// The pose at `target`, from samples stamped at or before `now`. Always finite and unit; an unusable sample is
    /// passed over. Before the feed's first sample: the identity, stamped `now`, with sample number 0.
    [[nodiscard]] virtual PredictedPose predict(const HeadPoseFeed& feed, TimePoint now, TimePoint target) = 0;
};

/// Names that make_predictor() accepts:
/// - `none`: the newest sample as it is;
/// - `constant-velocity`: linear and angular velocity of the last 30 ms, carried on from the newest sample and dying
///   away with the horizon (steady_span()); one wild sample in that time changes nothing;
/// - `double-exponential`: DoubleExponential;
/// - `kalman`: KalmanHeadFilter;
/// - `adaptive`: AdaptiveMotion, the best on every recording (docs/latency.md has the table);
/// - `oracle`: the recording's own pose at `target`. Its feed must be a ForeseeingHeadPoseFeed (programmer error
///   otherwise); `newest_sample` is still the newest one at `now`, so that latencies stay comparable.
/// All but `none` and `constant-velocity` look at `now` only through what the feed has by then, and remember what they
/// saw: ask them in the order of time.
[[nodiscard]] std::vector<std::string_view> predictor_names();
[[nodiscard]] Result<std::unique_ptr<HeadPosePredictor>> make_predictor(std::string_view name);

/// What live runs and every client use unless told otherwise.
inline constexpr std::string_view kDefaultPredictor = "adaptive";

}  // namespace lw
