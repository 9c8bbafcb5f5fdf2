#include "frame_link/prediction_error.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "tests/frame_link/disturbed_feed.h"
#include "tests/support/shared_data.h"

namespace lw {
namespace {

constexpr std::array<Duration, 1> k25ms{std::chrono::milliseconds{25}};

PredictionError error_at_25_ms(std::string_view predictor_name, const HeadPoseFeed& tracker, const TraceFeed& head,
                               double seconds) {
    const auto predictor = *make_predictor(predictor_name);
    return prediction_errors(*predictor, tracker, head, TimePoint{}, at_seconds(seconds), k25ms).front();
}

// A head that turns at 90 degrees/s for a second and rests for another: ramps of a known error.
Trace turn_and_rest() {
    std::vector<TimedPose> poses;
    double yaw_rad = 0.0;
    for (int ms = 0; ms < 12'000; ++ms) {
        const bool turns = ms / 1000 % 2 == 0;
        if (turns) yaw_rad += glm::radians(90.0) * 1e-3;
        poses.push_back({1e-3 * ms, {{0.0, 1.6, 0.0}, glm::angleAxis(yaw_rad, glm::dvec3{0.0, 1.0, 0.0})}});
    }
    return Trace{"turn and rest", std::move(poses)};
}

TEST(PredictionError, OfNoPredictionIsTheMotionSinceTheSample) {
    const TraceFeed feed{turn_and_rest(), TimePoint{}, 1000.0};
    const PredictionError error = error_at_25_ms("none", feed, feed, 12.0);
    // 90 degrees/s for 25 ms; it turns in five of the eleven seconds that count, each begun 25 ms late.
    EXPECT_NEAR(error.turn_deg.max, 2.25, 1e-6);
    EXPECT_NEAR(error.turn_deg.mean, 2.25 * 5.0 / 11.0, 0.01);
    EXPECT_NEAR(error.move_mm.max, 0.0, 1e-9);
}

TEST(PredictionError, KnowsWhereAHeadStops) {
    const TraceFeed feed{turn_and_rest(), TimePoint{}, 1000.0};
    const auto stops = stops_of(feed, TimePoint{}, at_seconds(12.0));
    ASSERT_EQ(stops.size(), 6u);
    for (std::size_t i = 0; i < stops.size(); ++i) {
        // The mean over the next 100 ms falls below 10 degrees/s when less than 11 ms of the turn are left.
        EXPECT_NEAR(seconds_of(stops[i]), 2.0 * static_cast<double>(i) + 1.0, 0.0111);
    }
    const PredictionError error = error_at_25_ms("none", feed, feed, 12.0);
    ASSERT_TRUE(error.turn_after_stop_deg.has_value());
    EXPECT_NEAR(error.turn_after_stop_deg->max, 2.25, 1e-6);
    EXPECT_NEAR(error.turn_after_stop_deg->p50, 0.0, 1e-6);
}

TEST(PredictionError, TheOracleHasNone) {
    const TraceFeed feed{*load_trace("shake"), TimePoint{}, 1000.0};
    EXPECT_NEAR(error_at_25_ms("oracle", feed, feed, 5.0).turn_deg.max, 0.0, 1e-9);
}

class BuiltInTracePrediction : public testing::TestWithParam<const char*> {};

TEST_P(BuiltInTracePrediction, TheDefaultHalvesTheError) {
    const TraceFeed feed{*load_trace(GetParam()), TimePoint{}, 1000.0};
    const double none = error_at_25_ms("none", feed, feed, 30.0).turn_deg.p95;
    EXPECT_LT(error_at_25_ms(kDefaultPredictor, feed, feed, 30.0).turn_deg.p95, 0.5 * none);
}

// Velocity that does not die away is worse than holding still 150 ms ahead of a head that shakes at 2 Hz and more.
TEST_P(BuiltInTracePrediction, FarAheadItIsNoWorseThanHoldingStill) {
    constexpr std::array<Duration, 2> kFar{std::chrono::milliseconds{150}, std::chrono::milliseconds{300}};
    const TraceFeed feed{*load_trace(GetParam()), TimePoint{}, 1000.0};
    const auto errors_of = [&](std::string_view name) {
        const auto predictor = *make_predictor(name);
        return prediction_errors(*predictor, feed, feed, TimePoint{}, at_seconds(30.0), kFar);
    };
    const auto none = errors_of("none");
    const auto best = errors_of(kDefaultPredictor);
    for (std::size_t i = 0; i < kFar.size(); ++i) EXPECT_LT(best[i].turn_deg.mean, 1.05 * none[i].turn_deg.mean);
}

INSTANTIATE_TEST_SUITE_P(Prediction, BuiltInTracePrediction, testing::Values("look-around", "walk", "shake"),
                         [](const auto& name) { return name.param[0] == 'l' ? "look_around" : name.param; });

constexpr std::array<const char*, 8> kRecordings{
    "eyenavgs_rutgers/user103_train.csv",  "eyenavgs_rutgers/user111_treehill.csv",
    "eyenavgs_rutgers/user113_truck.csv",  "eyenavgs_rutgers/user117_treehill.csv",
    "eyenavgs_rutgers/user122_stump.csv",  "questset/sample_movement_data.csv",
    "head_trajectory/quest_pro_traj1.txt", "head_trajectory/real_world_head_movement_example_0.bag"};
constexpr double kSeconds = 60.0;

class DataRecordedTracePrediction : public testing::TestWithParam<const char*> {
protected:
    static Trace trace() { return *load_trace((test::shared_data_dir() / "head_traces" / GetParam()).string()); }
};

// What the project promises of its default at a display's horizon, on every recording; docs/latency.md has the table.
TEST_P(DataRecordedTracePrediction, TheDefaultHalvesTheErrorAndDoesNotOvershootStops) {
    LW_NEED_SHARED_DATA();
    const TraceFeed feed{trace(), TimePoint{}, 1000.0};
    const PredictionError none = error_at_25_ms("none", feed, feed, kSeconds);
    const PredictionError best = error_at_25_ms(kDefaultPredictor, feed, feed, kSeconds);
    EXPECT_LT(best.turn_deg.p95, 0.5 * none.turn_deg.p95);
    EXPECT_LT(best.move_mm.p95, 0.5 * none.move_mm.p95);
    EXPECT_LT(best.turn_after_stop_deg.value_or(Distribution{}).p95, 1.0);
}

// A tracker that pauses, glitches, trembles, or stamps its samples badly: prediction never makes it worse by a fifth.
TEST_P(DataRecordedTracePrediction, TheDefaultBearsABadTracker) {
    LW_NEED_SHARED_DATA();
    const Trace recorded = trace();
    const TraceFeed head{recorded, TimePoint{}, 1000.0};
    const std::array<std::pair<const char*, test::Disturbance>, 4> kinds{{
        {"gaps", {0.9, 0.15, 0.0, 0.0, 0.0, 0.0}},
        {"glitches", {0.0, 0.0, 0.31, 0.0, 0.0, 0.0}},
        {"noise", {0.0, 0.0, 0.0, 0.0, 0.003, 0.003}},
        {"stamps", {0.0, 0.0, 0.0, 0.002, 0.0, 0.0}},
    }};
    for (const auto& [what, wrong] : kinds) {
        SCOPED_TRACE(what);
        const test::DisturbedFeed tracker{recorded, 250.0, wrong};
        const PredictionError none = error_at_25_ms("none", tracker, head, kSeconds);
        const PredictionError best = error_at_25_ms(kDefaultPredictor, tracker, head, kSeconds);
        EXPECT_LT(best.turn_deg.mean, 1.2 * none.turn_deg.mean);
        EXPECT_LT(best.turn_deg.p95, 1.2 * none.turn_deg.p95);
        EXPECT_LT(best.turn_deg.p99, 1.2 * none.turn_deg.p99);
        EXPECT_LT(best.move_mm.p95, 1.2 * none.move_mm.p95);
        EXPECT_LT(best.move_mm.p99, 1.2 * none.move_mm.p99);
    }
}

INSTANTIATE_TEST_SUITE_P(Data, DataRecordedTracePrediction, testing::ValuesIn(kRecordings), [](const auto& recording) {
    std::string name = std::filesystem::path{recording.param}.stem().string();
    std::replace_if(
        name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
    return name;
});

}  // namespace
}  // namespace lw
