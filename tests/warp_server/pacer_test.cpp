#include "warp_server/pacer.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "warp_server/virtual_display.h"

namespace lw {
namespace {

constexpr double kHz = 90.0;

struct RunResult {
    int refreshes = 0;
    int missed = 0;
    Duration mean_lead{};
};

// Drives the pacer against a display for `seconds`; `work` is the time from the planned wake to presenting.
RunResult run(Pacer& pacer, double seconds, const std::function<Duration()>& work) {
    const VirtualDisplay display{TimePoint{}, kHz, {1, 1}};
    RunResult result;
    Duration total_lead{};
    TimePoint now{};
    TimePoint last_scanout{};
    while (now < at_seconds(seconds)) {
        const Refresh next = display.next_refresh(std::max(now, last_scanout));
        const PacerPlan plan = pacer.next_wake(now, next);
        result.missed += static_cast<int>(plan.refresh.number - next.number);
        result.refreshes += static_cast<int>(plan.refresh.number - next.number) + 1;
        EXPECT_GE(plan.wake, now);
        now = plan.wake + work();
        if (now > plan.refresh.scanout_begin) ++result.missed;
        total_lead += plan.refresh.scanout_begin - plan.wake;
        pacer.finished({plan.refresh, plan.wake, now});
        last_scanout = plan.refresh.scanout_begin;
    }
    result.mean_lead = total_lead / std::max(1, result.refreshes);
    return result;
}

TEST(Pacer, StartsEarlyBeforeItKnowsTheWork) {
    const Pacer pacer;
    const Refresh refresh{10, at_seconds(1.0), from_seconds(1.0 / kHz)};
    const PacerPlan plan = pacer.next_wake(at_seconds(0.5), refresh);
    EXPECT_EQ(plan.refresh.number, 10u);
    EXPECT_NEAR(to_ms(refresh.scanout_begin - plan.wake), Pacer::kUnlearntLead * 1000.0 / kHz, 1e-6);
}

TEST(Pacer, AFixedLeadIsKeptWhateverHappens) {
    PacerSettings settings;
    settings.fixed_lead = from_ms(5.0);
    Pacer pacer{settings};
    run(pacer, 1.0, [] { return from_ms(8.0); });
    EXPECT_EQ(pacer.lead(from_ms(11.0)), from_ms(5.0));
}

TEST(Pacer, SteadyWorkLeavesLittleMoreLeadThanItNeeds) {
    Pacer pacer;
    run(pacer, 1.0, [] { return from_ms(3.0); });
    const RunResult result = run(pacer, 10.0, [] { return from_ms(3.0); });
    EXPECT_EQ(result.missed, 0);
    // The smallest margin is an eighth of a period.
    EXPECT_LE(to_ms(result.mean_lead), 3.01 + 0.125 * 1000.0 / kHz);
}

// A strip has its own time to be ready in once more, and halves of 5.6 ms at most 4.5.
TEST(Pacer, StripsAreReadyEarlierForTheirTime) {
    PacerSettings halves;
    halves.strips = 2;
    Pacer pacer{halves};
    for (std::uint64_t slot = 0; slot < 100; ++slot) {
        const Refresh refresh{slot, at_seconds(static_cast<double>(slot) / (2.0 * kHz)), from_seconds(0.5 / kHz)};
        pacer.finished({refresh, refresh.scanout_begin - from_ms(2.0), refresh.scanout_begin - from_ms(1.0)});
    }
    EXPECT_NEAR(to_ms(pacer.lead(from_seconds(0.5 / kHz))), 1.0 + 4.5, 0.01);
}

// A head that turns away from where each frame was drawn, ten frames a second.
TEST(Pacer, FollowsWorkThatGrowsWithinTheLifeOfEachFrame) {
    Pacer pacer;
    int picture = 0;
    const auto work = [&] { return from_ms(2.0 + 0.5 * (picture++ % 9)); };
    run(pacer, 2.0, work);
    const RunResult result = run(pacer, 10.0, work);
    EXPECT_EQ(result.missed, 0);
    // 2 to 6 ms, 4 in the mean, growing by half a millisecond at a time.
    EXPECT_LE(to_ms(result.mean_lead), 4.5 + 0.5 + 0.126 * 1000.0 / kHz);
}

TEST(Pacer, NeverWakesBeforeNow) {
    const Pacer pacer;
    const Refresh refresh{1, at_seconds(1.0), from_seconds(1.0 / kHz)};
    const TimePoint now = refresh.scanout_begin - from_ms(1.0);
    EXPECT_EQ(pacer.next_wake(now, refresh).wake, now);
}

TEST(Pacer, LearnsWorkWithNoiseAndMissesAtMostOnePercent) {
    Pacer pacer;
    std::mt19937 random{7};
    std::exponential_distribution<double> tail{2.0};  // mean 0.5 ms, p99 2.3 ms above the floor
    const auto work = [&] { return from_ms(2.5 + tail(random)); };
    run(pacer, 2.0, work);
    const RunResult result = run(pacer, 60.0, work);
    EXPECT_LE(result.missed, result.refreshes / 100);
    EXPECT_LE(to_ms(result.mean_lead), 8.0);  // p99 is 4.8 ms; the largest of 5400 is about 6.8 ms
}

TEST(Pacer, ASingleDisturbanceDoesNotKeepTheLeadLong) {
    Pacer pacer;
    run(pacer, 2.0, [] { return from_ms(3.0); });
    bool disturbed = false;
    run(pacer, 0.1, [&] { return std::exchange(disturbed, true) ? from_ms(3.0) : from_ms(30.0); });
    run(pacer, 8.0, [] { return from_ms(3.0); });
    // The window leaves the 30 ms out, and no lead would have helped.
    EXPECT_LE(to_ms(pacer.lead(from_seconds(1.0 / kHz))), 3.05 + 0.125 * 1000.0 / kHz);
}

TEST(Pacer, DisturbancesInARowDoNotKeepTheLeadLong) {
    Pacer pacer;
    run(pacer, 4.0, [] { return from_ms(3.0); });
    int pictures = 0;
    const auto disturbed = [&] { return ++pictures % 9 == 0 ? from_ms(8.5) : from_ms(3.0); };
    EXPECT_EQ(run(pacer, 0.4, disturbed).missed, 4);
    run(pacer, 0.1, [] { return from_ms(3.0); });
    EXPECT_LE(to_ms(pacer.lead(from_seconds(1.0 / kHz))), 3.05 + 4 * 0.25 + 0.125 * 1000.0 / kHz);
}

TEST(Pacer, TheFirstPicturesDoNotKeepTheLeadLong) {
    Pacer pacer;
    int pictures = 0;
    run(pacer, 0.4, [&] { return ++pictures < 3 ? from_ms(12.0) : from_ms(3.0); });
    EXPECT_LE(to_ms(pacer.lead(from_seconds(1.0 / kHz))), 3.05 + 0.125 * 1000.0 / kHz);
}

TEST(Pacer, BacksOffWhenWorkGrows) {
    Pacer pacer;
    run(pacer, 2.0, [] { return from_ms(3.0); });
    const RunResult after = run(pacer, 4.0, [] { return from_ms(7.0); });
    // The first such picture is late; the next is expected to take as long.
    EXPECT_LE(after.missed, 1);
    EXPECT_GE(to_ms(pacer.lead(from_seconds(1.0 / kHz))), 7.3);
}

TEST(Pacer, AnOverrunDoesNotDelayTheRefreshesAfterIt) {
    Pacer pacer;
    run(pacer, 2.0, [] { return from_ms(10.0); });  // of 11.1: little slack to catch up with
    int pictures = 0;
    const RunResult result = run(pacer, 1.0, [&] { return ++pictures == 20 ? from_ms(15.0) : from_ms(10.0); });
    // The picture that took too long, and the refresh that it left no time for.
    EXPECT_EQ(result.missed, 2);
}

TEST(Pacer, WorkLongerThanAPeriodAimsWhereItCanArrive) {
    Pacer pacer;
    run(pacer, 2.0, [] { return from_ms(25.0); });
    const Refresh next{100, at_seconds(5.0), from_seconds(1.0 / kHz)};
    const TimePoint now = next.scanout_begin - from_ms(2.0);
    const PacerPlan plan = pacer.next_wake(now, next);
    EXPECT_TRUE(pacer.is_too_slow_for(next.period));
    EXPECT_GE(plan.refresh.scanout_begin - plan.wake, from_ms(25.0));
    // Not a refresh later than needed.
    EXPECT_LT(plan.refresh.scanout_begin - next.period - now, from_ms(25.0) + from_ms(11.2));
    EXPECT_EQ(plan.refresh.scanout_begin - next.scanout_begin,
              static_cast<Duration::rep>(plan.refresh.number - next.number) * next.period);
}

}  // namespace
}  // namespace lw
