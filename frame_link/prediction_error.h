#pragma once
/// How far a predictor is from what the head did: the numbers of the table in docs/latency.md.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/statistics.h"
#include "frame_link/prediction.h"

namespace lw {

/// Errors of one predictor at one horizon.
struct PredictionError {
    Distribution turn_deg;  ///< angle between predicted and true orientation
    Distribution move_mm;   ///< distance between predicted and true position
    std::optional<Distribution>
        turn_after_stop_deg;  ///< of predictions for the moments after stops; none without stops
};

/// When a head that turned at more than 60 degrees/s came to rest: within a quarter of a second it is below 10
/// degrees/s, and stays so over each half of the kAfterStop that follow.
/// @return moments of coming to rest, ascending
[[nodiscard]] std::vector<TimePoint> stops_of(const ForeseeingHeadPoseFeed& head, TimePoint begin, TimePoint end);
inline constexpr Duration kAfterStop = std::chrono::milliseconds{200};

/// Asks the predictor every 10 ms of [begin, end) for the pose at each horizon after the moment of asking, in the order
/// of time. The first second, in which a filter learns its head, is asked for and not counted.
/// @param tracker  what the predictor sees
/// @param head     what the head did
/// @param horizons at least one, each at least zero
/// @return one entry for each horizon. `end` is more than a second and the longest horizon after `begin`.
[[nodiscard]] std::vector<PredictionError> prediction_errors(HeadPosePredictor& predictor, const HeadPoseFeed& tracker,
                                                             const ForeseeingHeadPoseFeed& head, TimePoint begin,
                                                             TimePoint end, std::span<const Duration> horizons);

}  // namespace lw
