/// The latency harness proves itself on a simulated machine: a client, a server and a display whose every delay is
/// known. No GL, no real time.

#include "apps/latency_harness.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>

#include "apps/latency_page.h"
#include "apps/live_report.h"
#include "tests/warp_server/simulated_display.h"
#include "warp_server/frame_warper.h"
#include "warp_server/server_loop.h"
#include "warp_server/virtual_display.h"

namespace lw {
namespace {

constexpr double kHz = 90.0;
constexpr glm::ivec2 kSize_px{64, 128};

/// A display that refreshes at another rate than it tells the server.
class LyingDisplay final : public Presenter {
public:
    LyingDisplay(VirtualDisplay& display, double told_hz) : display_{display}, told_{TimePoint{}, told_hz} {}
    [[nodiscard]] Refresh next_refresh(TimePoint now) const override { return told_.after(now); }
    void present(const DisplayFrame& frame, const Refresh& refresh) override { display_.present(frame, refresh); }
    void present_strip(const DisplayFrame& strip, const Refresh& slot, const Strip& place) override {
        display_.present_strip(strip, slot, place);
    }

private:
    VirtualDisplay& display_;
    SteadyRefreshes told_;
};

struct Machine {
    InjectedDelays inject;
    int strips = 1;
    double told_hz = kHz;
    double warp_ms = 2.0;
};

// A client that publishes every 97.3 ms a frame drawn for a head sample 80 ms old, and a head that turns at 1 rad/s.
LiveResult simulate(const Machine& machine, double seconds) {
    LiveResult result;
    result.strips = machine.strips;
    if (machine.inject.any()) result.injection = InjectionPlan{machine.inject, TimePoint{}};

    test::SimulatedClock clock;
    FrameExchange exchange;
    const test::FormulaHeadFeed tracker{[](TimePoint time) {
        return Pose{{}, glm::angleAxis(seconds_of(time), glm::dvec3{0.0, 1.0, 0.0})};
    }};
    const DelayedHeadFeed head{tracker, result.injection};
    const test::StillMovers movers{0};
    test::NewestSample predictor;
    const double work_ms = machine.warp_ms / machine.strips;
    FrameWarper warper{std::make_unique<test::TimedMethod>(clock, [work_ms] { return from_ms(work_ms); }),
                       std::make_unique<test::NoFill>()};
    VirtualDisplay display{TimePoint{}, kHz, kSize_px};
    PhotonWatchSettings watch;
    watch.strips = machine.strips;
    watch.panel_latency = [&](TimePoint scanout) { return result.injection.delay(Injected::present, scanout); };
    display.watch_photons(clock, watch);
    LyingDisplay told{display, machine.told_hz};

    ServerSettings settings;
    settings.camera.size_px = kSize_px;
    settings.strips = machine.strips;
    settings.photon_codes = true;
    ServerLoop loop{ServerParts{clock, exchange, head, movers, predictor, warper, told}, settings};

    struct Waiting {
        TimePoint due;
        std::uint64_t index;
        TimePoint pose_sampled;
    };
    std::deque<Waiting> line;
    TimePoint next_publication = at_seconds(0.05);
    while (clock.now() < at_seconds(seconds)) {
        // The server looks once per picture; what came until its wake-up is there a little too early, by its lead.
        for (; next_publication <= clock.now(); next_publication += from_ms(97.3)) {
            ClientFrameRecord frame;
            frame.index = result.app_frames.size() + 1;
            frame.times.published = next_publication;
            frame.times.pose_sampled = next_publication - from_ms(80.0);
            result.app_frames.push_back(frame);
            line.push_back({next_publication + result.injection.delay(Injected::app, next_publication), frame.index,
                            frame.times.pose_sampled});
        }
        for (; !line.empty() && line.front().due <= clock.now(); line.pop_front()) {
            exchange.publish(test::plain_frame(line.front().index, line.front().pose_sampled, Rgba8{90, 90, 90, 255}));
        }
        loop.show_next();
    }
    result.parts = loop.records();
    result.refreshes = worst_strips(result.parts, machine.strips);
    result.warp_times = warp_times(result.parts, machine.strips);
    const auto seen = display.seen();
    result.seen.assign(seen.begin(), seen.end());
    return result;
}

TEST(LatencyHarness, ReadsEveryCodeOfACleanRun) {
    const LatencyHarness harness = latency_of(simulate({}, 10.0));
    EXPECT_EQ(harness.suspect, "");
    EXPECT_EQ(harness.codes_bad, 0u);
    EXPECT_GE(harness.codes_read, 880u);
    EXPECT_TRUE(harness.in_phase);
    for (const SeenRefresh& refresh : harness.refreshes) {
        // Lead at most 0.8 of a period until it is learnt, half a period of scan-out, the tracker's 1 ms.
        EXPECT_GT(to_ms(refresh.motion_to_photon), 0.5e3 / kHz);
        EXPECT_LT(to_ms(refresh.motion_to_photon), 1.3e3 / kHz + 1.0);
        // 80 ms when published, shown for 97.3 more, and up to a refresh and a half until seen.
        EXPECT_GT(to_ms(refresh.frame_age), 80.0);
        EXPECT_LT(to_ms(refresh.frame_age), 80.0 + 97.3 + 1.5e3 / kHz + 12.0);
    }
}

TEST(LatencyHarness, FindsEachInjectedDelay) {
    for (const InjectedDelays& inject : {InjectedDelays{20.0, 35.0, 11.0}, InjectedDelays{7.3, 60.0, 3.0}}) {
        const LatencyHarness harness = latency_of(simulate({inject}, 40.0));
        ASSERT_EQ(harness.suspect, "");
        EXPECT_NEAR(harness.recovered.tracker_ms.value_or(-1.0), *inject.tracker_ms, 1.0);
        EXPECT_NEAR(harness.recovered.app_ms.value_or(-1.0), *inject.app_ms, 1.0);
        EXPECT_NEAR(harness.recovered.present_ms.value_or(-1.0), *inject.present_ms, 1.0);
    }
}

TEST(LatencyHarness, FindsNothingWhereNothingWasInjected) {
    const LatencyHarness harness = latency_of(simulate({InjectedDelays{0.0, 0.0, 0.0}}, 40.0));
    EXPECT_NEAR(harness.recovered.tracker_ms.value_or(-1.0), 0.0, 0.5);
    EXPECT_NEAR(harness.recovered.app_ms.value_or(-1.0), 0.0, 1.0);
    EXPECT_NEAR(harness.recovered.present_ms.value_or(-1.0), 0.0, 0.5);
}

TEST(LatencyHarness, GivesNoDelayFromTooShortARun) {
    const LatencyHarness harness = latency_of(simulate({InjectedDelays{20.0, 35.0, 11.0}}, 8.0));
    EXPECT_FALSE(harness.recovered.tracker_ms);
    EXPECT_FALSE(harness.recovered.app_ms);
    EXPECT_FALSE(harness.recovered.present_ms);
}

TEST(LatencyHarness, SuspectsADisplayOutOfPhase) {
    Machine machine;
    machine.told_hz = 90.7;
    const LiveResult result = simulate(machine, 20.0);
    EXPECT_THAT(latency_of(result).suspect, testing::HasSubstr("not in phase"));
    Report report{Subcommand::measure};
    describe_live_run(report, Options{}, result);
    EXPECT_THAT(report.text(), testing::HasSubstr("\"motion_to_photon\": null"));
    EXPECT_THAT(report.text(), testing::HasSubstr("\"in_phase\": false"));
}

// Pictures that come too late are no disagreement: the display shows what the server knows it shows.
TEST(LatencyHarness, AServerThatMissesIsStillInPhase) {
    for (const auto& [strips, warp_ms] :
         {std::pair{1, 10.9}, std::pair{1, 15.0}, std::pair{1, 40.0}, std::pair{8, 11.0}, std::pair{8, 24.0}}) {
        Machine machine;
        machine.strips = strips;
        machine.warp_ms = warp_ms;
        const LatencyHarness harness = latency_of(simulate(machine, 10.0));
        EXPECT_EQ(harness.suspect, "") << strips << " strips, " << warp_ms << " ms";
        EXPECT_DOUBLE_EQ(harness.in_phase_share, 1.0) << strips << " strips, " << warp_ms << " ms";
    }
}

TEST(LatencyHarness, SuspectsCodesThatCannotBeRead) {
    LiveResult result = simulate({}, 10.0);
    for (std::size_t i = 0; i < result.seen.size(); i += 20) result.seen[i].code.reset();
    EXPECT_THAT(latency_of(result).suspect, testing::HasSubstr("could not be read"));
    EXPECT_THAT(latency_of(simulate({}, 2.0)).suspect, testing::HasSubstr("only"));
}

TEST(LatencyHarness, AReportOfStripsIsThatOfTheWorstAndMuchYounger) {
    Machine machine;
    machine.strips = 8;
    const LiveResult result = simulate(machine, 20.0);
    const LatencyHarness strips = latency_of(result);
    ASSERT_EQ(strips.suspect, "");
    EXPECT_EQ(count_misses(result.refreshes).refreshes, result.refreshes.size());
    const LatencyHarness whole = latency_of(simulate({}, 20.0));
    const auto last_ms = [](const LatencyHarness& harness) { return to_ms(harness.refreshes.back().motion_to_photon); };
    // 0.25 ms of work for each strip, a strip's time of margin, half a strip, the tracker's millisecond.
    EXPECT_LT(last_ms(strips), 0.25 + (1.0 + 0.5) * 1e3 / kHz / 8.0 + 1.05);
    EXPECT_GT(last_ms(whole), 2.3 + 0.5e3 / kHz);
}

TEST(MostCommonDelay, IsWhereMostIntervalsOverlap) {
    EXPECT_FALSE(most_common_delay_ms({}));
    EXPECT_DOUBLE_EQ(*most_common_delay_ms({{10.0, 20.0}}), 15.0);
    EXPECT_DOUBLE_EQ(*most_common_delay_ms({{10.0, 20.0}, {18.0, 28.0}, {9.0, 19.0}, {40.0, 50.0}}), 18.5);
}

TEST(LatencyPage, HoldsTheTimeLineAndTheHistograms) {
    const LiveResult result = simulate({}, 10.0);
    const std::string page = latency_page(Options{}, result, latency_of(result));
    for (const char* part :
         {"What each thread did when", "Motion to photon", "Frame age", "client draws", "display shows", "<svg"}) {
        EXPECT_THAT(page, testing::HasSubstr(part));
    }
    const SvgPlot histogram = histogram_of("h", "ms", {1.0, 1.0, 1.0, 2.0});
    double area = 0.0;
    const auto& outline = histogram.series.at(0);
    for (std::size_t i = 0; i < outline.x.size(); i += 2) area += outline.y[i];
    EXPECT_NEAR(area, 100.0, 1e-9);
}

}  // namespace
}  // namespace lw
