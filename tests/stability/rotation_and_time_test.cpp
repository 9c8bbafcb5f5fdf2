/// Rotations that are hard on arithmetic, and time that has run for a month.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "apps/stability/case_random.h"
#include "core/pose.h"
#include "frame_link/prediction.h"
#include "frame_link/sampled_head_feed.h"
#include "frame_link/trace.h"
#include "warp_server/pacer.h"
#include "warp_server/virtual_display.h"

namespace lw::stability {
namespace {

using std::numbers::pi;

// How far the columns are from being orthonormal.
double skew_of(const glm::dquat& q) {
    const glm::dmat3 m = glm::mat3_cast(q);
    double worst = 0.0;
    for (int a = 0; a < 3; ++a) {
        for (int b = a; b < 3; ++b) worst = std::max(worst, std::abs(glm::dot(m[a], m[b]) - (a == b ? 1.0 : 0.0)));
    }
    return worst;
}

TEST(Rotations, TenMillionSmallUpdatesStayOrthonormal) {
    CaseRandom random{1};
    std::array<Pose, 64> steps;
    for (Pose& step : steps) {
        const double angle_rad = random.log_uniform(1e-9, 0.1);
        step = {random.direction() * 1e-3, glm::angleAxis(angle_rad, random.direction())};
    }
    Pose pose{{0.0, 1.6, 0.0}, random.rotation()};
    for (std::size_t i = 0; i < 10'000'000; ++i) pose = compose(pose, steps[i % steps.size()]);
    EXPECT_LT(skew_of(pose.orientation), 1e-12);
    EXPECT_TRUE(sanitised(pose).has_value());
}

// The same small step forth and back: what is left is drift, a random walk of roundings of 1e-16.
TEST(Rotations, ForthAndBackComesHome) {
    const Pose start{{1.0, 2.0, 3.0}, glm::angleAxis(0.7, glm::normalize(glm::dvec3{1, 2, 3}))};
    const Pose step{{0.01, -0.02, 0.005}, glm::angleAxis(0.013, glm::normalize(glm::dvec3{-3, 1, 2}))};
    const Pose back = inverse(step);
    Pose pose = start;
    for (int i = 0; i < 1'000'000; ++i) pose = compose(compose(pose, step), back);
    EXPECT_LT(angle_between_rad(pose.orientation, start.orientation), 1e-11);
    EXPECT_LT(glm::length(pose.position_m - start.position_m), 1e-10);
}

TEST(Rotations, AnglesFromNothingToHalfATurn) {
    CaseRandom random{2};
    for (const double angle_rad : {0.0, 1e-300, 1e-18, 1e-9, 1e-3, 1.0, pi - 1e-9, pi}) {
        for (int i = 0; i < 50; ++i) {
            const glm::dquat from = random.rotation();
            const glm::dquat to = from * from_rotation_vector(random.direction() * angle_rad);
            // Relative where the angle is tiny: 1e-16 of a quaternion's parts is what a double tells.
            EXPECT_NEAR(angle_between_rad(from, to), angle_rad, 1e-15 + 1e-15 * angle_rad);
            EXPECT_NEAR(angle_between_rad(from, -to), angle_rad, 1e-15 + 1e-15 * angle_rad) << "other sign";
            const Pose middle = interpolate({{}, from}, {{}, -to}, 0.5);
            EXPECT_LT(skew_of(middle.orientation), 1e-14);
            EXPECT_NEAR(angle_between_rad(from, middle.orientation), 0.5 * angle_rad, 2e-15);
        }
    }
}

TEST(Rotations, LengthsThatAreNoneAndOnesThatAreOff) {
    const glm::dquat unit = glm::angleAxis(0.4, glm::normalize(glm::dvec3{2, -1, 1}));
    for (const double length : {1e-5, 0.5, 1.0 + 1e-9, 7.0, 1e150}) {
        const auto pose = sanitised(Pose{{}, unit * length});
        ASSERT_TRUE(pose) << length;
        EXPECT_LT(skew_of(pose->orientation), 1e-14);
        EXPECT_LT(angle_between_rad(pose->orientation, unit), 1e-15);
    }
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinite = std::numeric_limits<double>::infinity();
    for (const glm::dquat& q : {unit * 0.0, unit * 1e-7, unit * 1e-300, glm::dquat{nan, 0, 0, 1},
                                glm::dquat{infinite, 0, 0, 1}, glm::dquat{1e308, 1e308, 1e308, 1e308}}) {
        EXPECT_FALSE(sanitised(Pose{{}, q}));
    }
}

TEST(Rotations, StraightUpAndDownHaveAHeading) {
    for (const double pitch_rad : {-0.5 * pi, 0.5 * pi, -0.5 * pi + 1e-9, 0.5 * pi - 1e-9}) {
        for (const double yaw_rad : {0.0, 1.0, -3.0}) {
            const glm::dquat q =
                glm::angleAxis(yaw_rad, glm::dvec3{0, 1, 0}) * glm::angleAxis(pitch_rad, glm::dvec3{1, 0, 0});
            EXPECT_NEAR(heading_rad(q), yaw_rad, 1e-8);
        }
    }
}

constexpr std::int64_t kMonth_ns = std::int64_t{30} * 24 * 3600 * 1'000'000'000;

Pose turning(double time_s) {
    return {{0.3 * time_s, 1.6, -0.1 * time_s}, glm::angleAxis(1.5 * time_s, glm::normalize(glm::dvec3{1, 4, -2}))};
}

// A tracker whose samples are given.
class GivenFeed final : public HeadPoseFeed {
public:
    std::vector<PoseSample> newest_first;
    [[nodiscard]] std::size_t newest(TimePoint now, std::span<PoseSample> samples) const override {
        std::size_t filled = 0;
        for (const PoseSample& sample : newest_first) {
            if (filled == samples.size()) break;
            if (sample.time <= now) samples[filled++] = sample;
        }
        return filled;
    }
};

GivenFeed samples_at(TimePoint newest, std::initializer_list<double> ages_s) {
    GivenFeed feed;
    std::uint64_t number = 1000;
    for (const double age_s : ages_s) {
        feed.newest_first.push_back({newest - from_seconds(age_s), turning(-age_s), number--});
    }
    return feed;
}

Pose predicted(std::string_view name, const HeadPoseFeed& feed, TimePoint now, double ahead_s) {
    auto predictor = make_predictor(name);
    return (*predictor)->predict(feed, now, now + from_seconds(ahead_s)).world_from_head;
}

// The oracle needs a recording and rests on no samples.
std::vector<std::string_view> predictors() {
    std::vector<std::string_view> names = predictor_names();
    std::erase(names, "oracle");
    return names;
}

TEST(Time, PredictionIsTheSameAfterAMonth) {
    const std::initializer_list<double> ages_s{0.0, 0.001, 0.002, 0.003, 0.004, 0.005, 0.01, 0.02};
    for (const std::string_view name : predictors()) {
        for (const double ahead_s : {0.0, 0.02, 0.1}) {
            const TimePoint early{Duration{1'234'567}};
            const Pose expected = predicted(name, samples_at(early, ages_s), early, ahead_s);
            for (const std::int64_t start_ns : {kMonth_ns, 100 * kMonth_ns}) {
                const TimePoint now = early + Duration{start_ns};
                const Pose pose = predicted(name, samples_at(now, ages_s), now, ahead_s);
                // Stamps are whole nanoseconds and only their differences count.
                EXPECT_LT(angle_between_rad(pose.orientation, expected.orientation), 1e-12) << name;
                EXPECT_LT(glm::length(pose.position_m - expected.position_m), 1e-12) << name;
            }
        }
    }
}

TEST(Time, ATrackerAndADisplayKeepCountForAMonth) {
    const Trace trace = *load_trace("walk");
    const TimePoint start{Duration{kMonth_ns}};
    const TraceFeed feed{trace, start, 1000.0};
    std::array<PoseSample, 3> samples;
    const TimePoint now = start + Duration{kMonth_ns} + Duration{17};
    ASSERT_EQ(feed.newest(now, samples), 3U);
    EXPECT_EQ(samples[0].number, static_cast<std::uint64_t>(kMonth_ns / 1'000'000) + 1);
    EXPECT_EQ(samples[0].time, start + Duration{kMonth_ns});
    EXPECT_EQ(samples[0].time - samples[1].time, Duration{1'000'000});

    const VirtualDisplay display{start, 90.0, {4, 4}};
    Refresh refresh = display.next_refresh(now);
    EXPECT_EQ(refresh.number, std::uint64_t{30} * 24 * 3600 * 90 + 1);
    for (int i = 0; i < 1000; ++i) {
        const Refresh next = display.next_refresh(refresh.scanout_begin);
        EXPECT_EQ(next.number, refresh.number + 1);
        EXPECT_NEAR(static_cast<double>((next.scanout_begin - refresh.scanout_begin).count()), 1e9 / 90.0, 1.5);
        refresh = next;
    }
    const PacerPlan plan = Pacer{}.next_wake(now, display.next_refresh(now));
    EXPECT_GE(plan.wake, now);
    EXPECT_LT(plan.wake, plan.refresh.scanout_begin);
}

TEST(Time, PredictionFromOneStaleAndGappedSamples) {
    const TimePoint now{Duration{kMonth_ns}};
    const auto expect_usable_of = [&](std::string_view name, const GivenFeed& feed, const char* what) {
        for (const double ahead_s : {-1.0, -0.001, 0.0, 0.05, 1.0, 1e6}) {
            const Pose pose = predicted(name, feed, now, ahead_s);
            ASSERT_TRUE(sanitised(pose)) << name << ", " << what;
            EXPECT_LT(skew_of(pose.orientation), 1e-12) << name << ", " << what;
            // 5 s of the motion in these samples, and a little. Nothing is shown a million seconds ahead: there it is
            // enough that the pose is one.
            if (ahead_s > 1.0) continue;
            EXPECT_LT(glm::length(pose.position_m), 2.3) << name << ", " << what << ", " << ahead_s;
        }
    };
    const auto expect_usable = [&](const GivenFeed& feed, const char* what) {
        for (const std::string_view name : predictors()) expect_usable_of(name, feed, what);
    };
    expect_usable(samples_at(now, {0.0}), "one sample");
    expect_usable(samples_at(now, {5.0, 5.001, 5.002}), "stale");
    expect_usable(samples_at(now, {0.0, 0.9, 1.0}), "a gap");
    expect_usable(samples_at(now, {0.0, 0.0, 0.0}), "equal stamps");
    expect_usable(samples_at(now, {0.0, -0.0, 0.001, 0.0005, 0.002}), "going back");
    GivenFeed signs = samples_at(now, {0.0, 0.001, 0.002, 0.003, 0.004});
    const Pose same_signs = predicted("constant-velocity", signs, now, 0.05);
    for (std::size_t i = 0; i < signs.newest_first.size(); i += 2) {
        signs.newest_first[i].world_from_head.orientation *= -1.0;
    }
    EXPECT_LT(angle_between_rad(predicted("constant-velocity", signs, now, 0.05).orientation, same_signs.orientation),
              1e-12);
}

TEST(Time, ATrackerThatRepeatsOrTurnsBackIsNotTaken) {
    SampledHeadFeed feed;
    const TimePoint start{Duration{kMonth_ns}};
    EXPECT_TRUE(feed.push(start, turning(0.0)));
    EXPECT_FALSE(feed.push(start, turning(0.1)));
    EXPECT_FALSE(feed.push(start - Duration{1}, turning(0.1)));
    EXPECT_TRUE(feed.push(start + Duration{1}, turning(0.1)));
    std::array<PoseSample, 4> samples;
    EXPECT_EQ(feed.newest(start + Duration{1}, samples), 2U);
}

}  // namespace
}  // namespace lw::stability
