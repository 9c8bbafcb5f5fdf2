#include "frame_link/prediction_error.h"

#include <glm/gtc/constants.hpp>

#include "core/check.h"

namespace lw {
namespace {

constexpr double kDegPerRad = 180.0 / glm::pi<double>();
constexpr Duration kAskEvery = std::chrono::milliseconds{10};
constexpr Duration kLearning = std::chrono::seconds{1};
constexpr double kMoving_deg_per_s = 60.0;
constexpr double kResting_deg_per_s = 10.0;
constexpr Duration kMovingSpan = std::chrono::milliseconds{50};
constexpr Duration kStopWithin = std::chrono::milliseconds{250};

double mean_speed_deg_per_s(const ForeseeingHeadPoseFeed& head, TimePoint from, Duration span) {
    const double angle_rad = angle_between_rad(head.pose_at(from).orientation, head.pose_at(from + span).orientation);
    return angle_rad * kDegPerRad / to_seconds(span);
}

bool is_after_stop(TimePoint time, std::span<const TimePoint> stops) {
    for (const TimePoint stop : stops) {
        if (time >= stop && time < stop + kAfterStop) return true;
    }
    return false;
}

struct Samples {
    std::vector<double> turn_deg;
    std::vector<double> move_mm;
    std::vector<double> after_stop_deg;
};

}  // namespace

std::vector<TimePoint> stops_of(const ForeseeingHeadPoseFeed& head, TimePoint begin, TimePoint end) {
    std::vector<TimePoint> stops;
    std::optional<TimePoint> moved;
    for (TimePoint time = begin + kMovingSpan; time + kAfterStop < end; time += kAskEvery) {
        if (!stops.empty() && time < stops.back() + kAfterStop) continue;
        if (mean_speed_deg_per_s(head, time - kMovingSpan, kMovingSpan) > kMoving_deg_per_s) moved = time;
        if (!moved || time - *moved > kStopWithin) continue;
        const bool rests = mean_speed_deg_per_s(head, time, kAfterStop / 2) < kResting_deg_per_s &&
                           mean_speed_deg_per_s(head, time + kAfterStop / 2, kAfterStop / 2) < kResting_deg_per_s;
        if (!rests) continue;
        stops.push_back(time);
        moved.reset();
    }
    return stops;
}

std::vector<PredictionError> prediction_errors(HeadPosePredictor& predictor, const HeadPoseFeed& tracker,
                                               const ForeseeingHeadPoseFeed& head, TimePoint begin, TimePoint end,
                                               std::span<const Duration> horizons) {
    LW_CHECK(!horizons.empty(), "no horizon");
    const std::vector<TimePoint> stops = stops_of(head, begin, end);
    std::vector<Samples> samples(horizons.size());
    for (TimePoint now = begin; now < end; now += kAskEvery) {
        for (std::size_t i = 0; i < horizons.size(); ++i) {
            const TimePoint target = now + horizons[i];
            const Pose predicted = predictor.predict(tracker, now, target).world_from_head;
            if (now - begin < kLearning || target >= end) continue;
            const Pose truth = head.pose_at(target);
            const double turn_deg = angle_between_rad(predicted.orientation, truth.orientation) * kDegPerRad;
            samples[i].turn_deg.push_back(turn_deg);
            samples[i].move_mm.push_back(glm::length(predicted.position_m - truth.position_m) * 1e3);
            if (is_after_stop(target, stops)) samples[i].after_stop_deg.push_back(turn_deg);
        }
    }
    std::vector<PredictionError> errors;
    for (const Samples& of_horizon : samples) {
        const auto turn = distribution_of(of_horizon.turn_deg);
        const auto move = distribution_of(of_horizon.move_mm);
        LW_CHECK(turn && move, "too short a time to judge a predictor");
        errors.push_back({*turn, *move, distribution_of(of_horizon.after_stop_deg)});
    }
    return errors;
}

}  // namespace lw
