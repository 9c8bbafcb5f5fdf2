#include <gtest/gtest.h>

#include "apps/replay_clock.h"

namespace lw::test {

namespace {

ReplayTiming timing(double app_hz, double display_hz, double latency_ms, double lead_ms) {
    return {app_hz, display_hz, from_ms(latency_ms), from_ms(lead_ms)};
}

TEST(ReplayClock, RefreshesComeAtTheDisplayRateAndGlowHalfAPeriodLater) {
    const ReplayClock clock{timing(10, 25, 100, 5)};
    const Refresh refresh = clock.refresh(7);
    EXPECT_EQ(refresh.number, 7u);
    EXPECT_EQ(refresh.scanout_begin, at_seconds(0.28));
    EXPECT_EQ(refresh.photon(), at_seconds(0.30));
    EXPECT_EQ(clock.latched(7), at_seconds(0.275));
}

TEST(ReplayClock, FramesArePublishedOneLatencyAfterTheirPose) {
    const ReplayClock clock{timing(10, 25, 80, 5)};
    EXPECT_EQ(clock.sampled(3), at_seconds(0.3));
    EXPECT_EQ(clock.published(3), at_seconds(0.38));
}

TEST(ReplayClock, TheDisplayStartsWithTheFirstFrameAfterTheWarmUp) {
    const ReplayClock clock{timing(10, 25, 100, 5)};
    // Frame 1 is published at 200 ms and latched 5 ms ahead, at 40 ms a refresh: number 6 begins at 240 ms.
    EXPECT_EQ(clock.first_refresh(), 6u);
    EXPECT_EQ(clock.frame_shown_at(6), 1u);
}

TEST(ReplayClock, ARefreshExactlyAtPublishingShowsTheNewFrame) {
    const ReplayClock clock{timing(10, 100, 100, 0)};
    EXPECT_EQ(clock.first_refresh(), 20u);
    EXPECT_EQ(clock.frame_shown_at(29), 1u);
    EXPECT_EQ(clock.frame_shown_at(30), 2u);
}

TEST(ReplayClock, EveryRefreshShowsTheNewestPublishedFrame) {
    for (const double app_hz : {3.0, 7.3, 10.0, 24.0}) {
        for (const double latency_ms : {0.0, 37.0, 250.0}) {
            const ReplayClock clock{timing(app_hz, 90, latency_ms, 5)};
            for (std::uint64_t n = clock.first_refresh(); n < clock.first_refresh() + 200; ++n) {
                const std::uint64_t frame = clock.frame_shown_at(n);
                EXPECT_LE(clock.published(frame), clock.latched(n));
                EXPECT_GT(clock.published(frame + 1), clock.latched(n));
            }
        }
    }
}

TEST(ReplayClock, TheFrameAgeIsOneToTwoPeriodsAsAtTheDefaultLatency) {
    const ReplayClock clock{timing(10, 25, 100, 5)};
    for (std::uint64_t n = clock.first_refresh(); n < 100; ++n) {
        const double age_ms = to_ms(clock.refresh(n).photon() - clock.sampled(clock.frame_shown_at(n)));
        // 100 ms to publish and at most 100 ms on the display, seen 5 ms and half of 40 ms after the latch.
        EXPECT_GE(age_ms, 125.0);
        EXPECT_LT(age_ms, 225.0);
    }
}

TEST(ReplayClock, TheMiddleOfAFramesLifeIsTheMiddleOfItsPhotonTimes) {
    const ReplayClock clock{timing(10, 100, 100, 5)};
    double first_s = 1e9;
    double last_s = 0.0;
    for (std::uint64_t n = clock.first_refresh(); n < 100; ++n) {
        if (clock.frame_shown_at(n) != 4) continue;
        first_s = std::min(first_s, seconds_of(clock.refresh(n).photon()));
        last_s = std::max(last_s, seconds_of(clock.refresh(n).photon()));
    }
    // Refreshes fall on a grid of 10 ms, so the mean of the first and the last is within half of that.
    EXPECT_NEAR(seconds_of(clock.middle_of_life(4)), (first_s + last_s) / 2, 0.005 + 1e-9);
}

}  // namespace

}  // namespace lw::test
