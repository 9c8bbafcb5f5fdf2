#include "frame_link/prediction.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "frame_link/trace.h"
#include "frame_link/velocity_fit.h"

namespace lw {
namespace {

/// A tracker at a steady rate whose poses a function says.
class FunctionFeed : public ForeseeingHeadPoseFeed {
public:
    FunctionFeed(double rate_hz, std::function<Pose(double)> pose_of)
        : rate_hz_{rate_hz}, pose_of_{std::move(pose_of)} {}

    std::size_t newest(TimePoint now, std::span<PoseSample> samples) const override {
        std::size_t filled = 0;
        for (auto k = static_cast<std::int64_t>(seconds_of(now) * rate_hz_ + 1e-6); k >= 0 && filled < samples.size();
             --k) {
            const TimePoint time = at_seconds(static_cast<double>(k) / rate_hz_);
            samples[filled++] = {time, pose_of_(seconds_of(time)), static_cast<std::uint64_t>(k) + 1};
        }
        return filled;
    }
    Pose pose_at(TimePoint time) const override { return pose_of_(seconds_of(time)); }

private:
    double rate_hz_;
    std::function<Pose(double)> pose_of_;
};

const glm::dvec3 kAxis = glm::normalize(glm::dvec3{0.3, 0.9, -0.2});

Pose steady_turn(double time_s) {
    return {{0.5 * time_s, 1.6 - 0.1 * time_s, 0.2}, glm::angleAxis(3.0 * time_s, kAxis)};
}

std::unique_ptr<HeadPosePredictor> predictor(std::string_view name) {
    auto made = make_predictor(name);
    EXPECT_TRUE(made.ok()) << name;
    return std::move(*made);
}

void expect_near(const Pose& actual, const Pose& expected, double tolerance_m, double tolerance_rad) {
    EXPECT_LE(glm::length(actual.position_m - expected.position_m), tolerance_m);
    EXPECT_LE(angle_between_rad(actual.orientation, expected.orientation), tolerance_rad);
}

TEST(Prediction, KnowsItsNames) {
    EXPECT_THAT(predictor_names(), testing::ElementsAre("none", "constant-velocity", "double-exponential", "kalman",
                                                        "adaptive", "oracle"));
    for (const std::string_view name : predictor_names()) EXPECT_TRUE(make_predictor(name).ok());
    const auto unknown = make_predictor("crystal-ball");
    ASSERT_FALSE(unknown.ok());
    EXPECT_EQ(unknown.error().message(),
              "unknown predictor: crystal-ball: use one of none, constant-velocity, double-exponential, kalman, "
              "adaptive, oracle");
}

TEST(Prediction, NoneIsTheNewestSample) {
    const FunctionFeed feed{1000.0, steady_turn};
    const PredictedPose predicted = predictor("none")->predict(feed, at_seconds(1.0004), at_seconds(1.05));
    EXPECT_EQ(predicted.newest_sample, at_seconds(1.0));
    EXPECT_EQ(predicted.sample_number, 1001U);
    expect_near(predicted.world_from_head, steady_turn(1.0), 1e-12, 1e-12);
}

TEST(Prediction, OracleKnowsTheFutureButCountsFromTheNewestSample) {
    const FunctionFeed feed{1000.0, steady_turn};
    const PredictedPose predicted = predictor("oracle")->predict(feed, at_seconds(1.0), at_seconds(1.3));
    EXPECT_EQ(predicted.newest_sample, at_seconds(1.0));
    expect_near(predicted.world_from_head, steady_turn(1.3), 1e-12, 1e-12);
}

// Steady motion is predicted exactly; 1e-9 covers time stamps rounded to a nanosecond at 3 rad/s and 0.5 m/s, ten
// times over since the velocity is fitted over 30 ms and carried on undiminished for 30 ms.
TEST(Prediction, ConstantVelocityIsExactForSteadyMotion) {
    for (const double rate_hz : {60.0, 72.0, 120.0, 1000.0, 8000.0}) {
        const FunctionFeed feed{rate_hz, steady_turn};
        const auto predict = predictor("constant-velocity");
        for (const double ahead_s : {0.0, 0.01, 0.02, 0.03}) {
            const PredictedPose predicted = predict->predict(feed, at_seconds(1.0), at_seconds(1.0 + ahead_s));
            expect_near(predicted.world_from_head, steady_turn(1.0 + ahead_s), 1e-7, 3e-7);
        }
    }
}

// steady_span(): 30 ms in full, then dying away by e over 80 ms; far ahead it is 110 ms' worth.
TEST(Prediction, VelocityDiesAwayWithTheHorizon) {
    EXPECT_EQ(steady_span(-0.02), -0.02);
    EXPECT_EQ(steady_span(0.03), 0.03);
    EXPECT_NEAR(steady_span(0.11), 0.03 + 0.08 * (1.0 - std::exp(-1.0)), 1e-12);
    const FunctionFeed feed{1000.0, steady_turn};
    const Pose far = predictor("constant-velocity")->predict(feed, at_seconds(1.0), at_seconds(9.0)).world_from_head;
    expect_near(far, steady_turn(1.11), 1e-7, 3e-7);
}

// The filters need time to settle: after a second of steady motion what is left is below a hundredth of a degree and a
// tenth of a millimetre. `adaptive` has learnt by then that this head goes on: it is held back by its ridge alone,
// which is as much evidence as 0.028 rad/s and 0.02 m/s give: (0.02 / 0.51)^2 of the way.
TEST(Prediction, FiltersFollowSteadyMotion) {
    for (const double rate_hz : {72.0, 120.0, 1000.0}) {
        const FunctionFeed feed{rate_hz, steady_turn};
        for (const std::string_view name : {"double-exponential", "kalman", "adaptive"}) {
            const auto predict = predictor(name);
            for (int ms = 0; ms <= 1000; ms += 10) {
                (void)predict->predict(feed, at_seconds(1e-3 * ms), at_seconds(1e-3 * ms));
            }
            const Pose pose = predict->predict(feed, at_seconds(1.0), at_seconds(1.03)).world_from_head;
            SCOPED_TRACE(fmt::format("{} at {} Hz", name, rate_hz));
            expect_near(pose, steady_turn(1.03), 1e-4, 2e-4);
        }
    }
}

// The same samples give the same pose, however often and for how many horizons a predictor is asked on the way: strips
// of one refresh ask for several.
TEST(Prediction, AskingMoreOftenChangesNothing) {
    const TraceFeed feed{*load_trace("walk"), TimePoint{}, 1000.0};
    for (const std::string_view name : {"double-exponential", "kalman", "adaptive"}) {
        const auto often = predictor(name);
        const auto seldom = predictor(name);
        for (int ms = 0; ms <= 2000; ms += 5) {
            (void)often->predict(feed, at_seconds(1e-3 * ms), at_seconds(1e-3 * ms + 0.01));
            (void)often->predict(feed, at_seconds(1e-3 * ms), at_seconds(1e-3 * ms + 0.1));
            if (ms % 100 == 0) (void)seldom->predict(feed, at_seconds(1e-3 * ms), at_seconds(1e-3 * ms));
        }
        EXPECT_EQ(often->predict(feed, at_seconds(2.0), at_seconds(2.05)).world_from_head,
                  seldom->predict(feed, at_seconds(2.0), at_seconds(2.05)).world_from_head)
            << name;
    }
}

TEST(Prediction, FiltersBeginAnewWhenTimeGoesBack) {
    const TraceFeed feed{*load_trace("walk"), TimePoint{}, 1000.0};
    for (const std::string_view name : {"double-exponential", "kalman", "adaptive"}) {
        const auto used = predictor(name);
        (void)used->predict(feed, at_seconds(8.0), at_seconds(8.0));
        const auto fresh = predictor(name);
        EXPECT_EQ(used->predict(feed, at_seconds(2.0), at_seconds(2.05)).world_from_head,
                  fresh->predict(feed, at_seconds(2.0), at_seconds(2.05)).world_from_head)
            << name;
    }
}

TEST(Prediction, StillHeadStaysBitForBit) {
    const Pose still{{0.1, 1.6, -0.3}, glm::angleAxis(0.7, kAxis)};
    const Pose unit = *sanitised(still);
    const FunctionFeed feed{1000.0, [&](double) { return unit; }};
    for (const std::string_view name : predictor_names()) {
        const Pose predicted = predictor(name)->predict(feed, at_seconds(1.0), at_seconds(1.1)).world_from_head;
        EXPECT_EQ(predicted.position_m, unit.position_m) << name;
        // normalize() may round the last bit of the quaternion, and a filter multiplies it at every sample.
        EXPECT_LE(angle_between_rad(predicted.orientation, unit.orientation), 1e-14) << name;
    }
}

// A sample that is 20 degrees and 30 cm off must not move the prediction, wherever in the window it lies.
TEST(Prediction, OneWildSampleChangesNothing) {
    for (const double rate_hz : {250.0, 1000.0}) {
        for (int back = 0; back < 6; ++back) {
            const FunctionFeed feed{rate_hz, [&](double time_s) {
                                        Pose pose = steady_turn(time_s);
                                        if (std::abs(time_s - (1.0 - back / rate_hz)) < 1e-6) {
                                            pose.position_m.x += 0.3;
                                            pose.orientation = pose.orientation * glm::angleAxis(0.35, kAxis);
                                        }
                                        return pose;
                                    }};
            const Pose predicted =
                predictor("constant-velocity")->predict(feed, at_seconds(1.0), at_seconds(1.03)).world_from_head;
            // The median of a few slopes that straddle the wild sample may pick one a little off: well below 1 %.
            expect_near(predicted, steady_turn(1.03), 1e-4, 1e-3);
        }
    }
}

TEST(Prediction, PassesOverUnusableSamples) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const FunctionFeed feed{1000.0, [&](double time_s) {
                                Pose pose = steady_turn(time_s);
                                if (time_s > 0.9985) pose.position_m.y = nan;
                                if (time_s > 0.9805 && time_s < 0.9855) pose.orientation = {0.0, 0.0, 0.0, 0.0};
                                return pose;
                            }};
    for (const std::string_view name : {"none", "constant-velocity", "double-exponential", "kalman", "adaptive"}) {
        const PredictedPose predicted = predictor(name)->predict(feed, at_seconds(1.0), at_seconds(1.01));
        EXPECT_EQ(predicted.newest_sample, at_seconds(0.998)) << name;
        EXPECT_TRUE(sanitised(predicted.world_from_head).has_value()) << name;
    }
    const PredictedPose predicted = predictor("constant-velocity")->predict(feed, at_seconds(1.0), at_seconds(1.01));
    expect_near(predicted.world_from_head, steady_turn(1.01), 1e-7, 3e-7);
}

TEST(Prediction, WithoutSamplesTheHeadIsAtTheOrigin) {
    const TraceFeed feed{*load_trace("walk"), at_seconds(10.0), 1000.0};
    for (const std::string_view name : {"none", "constant-velocity", "double-exponential", "kalman", "adaptive"}) {
        const PredictedPose predicted = predictor(name)->predict(feed, at_seconds(9.0), at_seconds(9.1));
        EXPECT_EQ(predicted.world_from_head, Pose{}) << name;
        EXPECT_EQ(predicted.sample_number, 0U) << name;
    }
    const PredictedPose first = predictor("constant-velocity")->predict(feed, at_seconds(10.0), at_seconds(10.1));
    EXPECT_EQ(first.sample_number, 1U) << "one sample has no velocity";
    expect_near(first.world_from_head, feed.pose_at(at_seconds(10.0)), 0.0, 1e-15);
}

// The point of predicting: nearer to the truth than not predicting, on smooth motion and at a display's lead.
TEST(Prediction, BeatsNoPredictionOnHumanMotion) {
    for (const char* name : {"look-around", "walk", "shake"}) {
        const TraceFeed feed{*load_trace(name), TimePoint{}, 1000.0};
        double none_rad = 0.0;
        double velocity_rad = 0.0;
        for (int i = 20; i < 1000; ++i) {
            const TimePoint now = at_seconds(0.05 * i);
            const TimePoint target = now + std::chrono::milliseconds{30};
            const auto error_rad = [&](std::string_view predictor_name) {
                const Pose pose = predictor(predictor_name)->predict(feed, now, target).world_from_head;
                return angle_between_rad(pose.orientation, feed.pose_at(target).orientation);
            };
            none_rad += error_rad("none");
            velocity_rad += error_rad("constant-velocity");
        }
        EXPECT_LT(velocity_rad, 0.5 * none_rad) << name;
    }
}

}  // namespace
}  // namespace lw
