#include "apps/live_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/live_strip.h"

namespace lw {
namespace {

constexpr double kPeriod_ms = 10.0;

// Ten refreshes of two rendered frames; the fourth was missed for lack of time, the fifth never begun.
LiveResult small_run() {
    LiveResult result;
    result.scheduling = Scheduling::nice;
    result.app_frames_shown = 2;
    for (std::uint64_t i = 0; i < 10; ++i) {
        DisplayRecord refresh;
        refresh.refresh = 100 + i;
        refresh.frame_index = i < 5 ? 1 : 2;
        refresh.scanout_begin = TimePoint{from_ms(1000.0 + kPeriod_ms * static_cast<double>(i))};
        refresh.photon = refresh.scanout_begin + from_ms(5.0);
        refresh.frame_pose_sampled = TimePoint{from_ms(i < 5 ? 900.0 : 950.0)};
        refresh.pose_sampled = refresh.scanout_begin - from_ms(4.0);
        refresh.planned_wake = refresh.latched = refresh.scanout_begin - from_ms(4.0);
        refresh.warp_begin = refresh.latched;
        refresh.warp_end = refresh.latched + from_ms(3.0);
        refresh.presented = refresh.warp_end;
        refresh.world_from_head.position_m.x = 0.01 * static_cast<double>(i);
        result.refreshes.push_back(refresh);
    }
    result.refreshes[3].presented = result.refreshes[3].scanout_begin + from_ms(1.0);
    result.refreshes[3].cause = MissCause::own;
    result.refreshes[4].presented = std::nullopt;
    result.refreshes[4].cause = MissCause::late_wakeup;
    result.parts = result.refreshes;
    result.warp_times = warp_times(result.parts, result.strips);
    for (std::uint64_t i = 0; i < 3; ++i) {
        ClientFrameRecord frame;
        frame.index = i + 1;
        frame.times.pose_sampled = TimePoint{from_ms(900.0 + 50.0 * static_cast<double>(i))};
        frame.times.published = frame.times.pose_sampled + from_ms(90.0);
        result.app_frames.push_back(frame);
        result.source_views.push_back({});
    }
    return result;
}

TEST(LiveReport, CountsMissesByCause) {
    const LiveSummary summary = summary_of(small_run());
    EXPECT_EQ(summary.display.refreshes, 10u);
    EXPECT_EQ(summary.display.missed, 2u);
    EXPECT_EQ(summary.display.own, 1u);
    EXPECT_EQ(summary.display.late_wakeup, 1u);
}

TEST(LiveReport, TellsTheClientsRateAndWhatWasNeverShown) {
    const LiveSummary summary = summary_of(small_run());
    EXPECT_DOUBLE_EQ(summary.app_hz, 20.0);
    EXPECT_EQ(summary.app_frames, 3u);
    EXPECT_EQ(summary.app_frames_dropped, 1u);
}

TEST(LiveReport, LatenciesAreThoseOfRefreshes) {
    const LiveSummary summary = summary_of(small_run());
    EXPECT_DOUBLE_EQ(summary.motion_to_photon_ms->min, 9.0);
    EXPECT_DOUBLE_EQ(summary.motion_to_photon_ms->max, 19.0);  // at the missed refreshes
    EXPECT_DOUBLE_EQ(summary.warp_ms->p50, 3.0);
}

TEST(WarpTimes, AddUpTheStripsOfARefresh) {
    // Ten strips of five refreshes, one of which lacks a strip.
    const std::vector<Duration> times = warp_times(small_run().parts, 2);
    ASSERT_EQ(times.size(), 4u);
    for (const Duration time : times) EXPECT_EQ(time, from_ms(6.0));
}

TEST(LiveReport, AnEmptyRunHasNoNumbersAndNoPicture) {
    const LiveResult nothing;
    const LiveSummary summary = summary_of(nothing);
    EXPECT_FALSE(summary.motion_to_photon_ms.has_value());
    EXPECT_EQ(summary.app_hz, 0.0);
    EXPECT_EQ(telling_refresh(nothing), nullptr);
    Report report{Subcommand::measure};
    describe_live_run(report, Options{}, nothing);
    EXPECT_THAT(report.text(), ::testing::HasSubstr("\"motion_to_photon\": null"));
}

TEST(LiveReport, HasTheKeysThatScriptsRead) {
    Report report{Subcommand::measure};
    describe_live_run(report, Options{}, small_run());
    for (const char* key : {"\"missed_own\": 1", "\"missed_late_wakeup\": 1", "\"scheduling\": \"nice\"",
                            "\"frame_age\": {", "\"warp_ms\": {", "\"dropped\": 1"}) {
        EXPECT_THAT(report.text(), ::testing::HasSubstr(key));
    }
}

TEST(LiveReport, TheCsvHasARowPerRefresh) {
    const std::string csv = refreshes_csv(small_run());
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 11);
    EXPECT_THAT(csv, ::testing::HasSubstr(
                         "\n100,1,900.000,996.000,996.000,996.000,996.000,999.000,999.000,1000.000,1005.000,,,,,,,\n"));
    EXPECT_THAT(csv, ::testing::HasSubstr("\n104,1,,,1036.000,,,,,1040.000,1045.000,late_wakeup,,,,,,\n"));
}

TEST(LiveStrip, ChoosesAShownRefreshOfOrdinaryAgeAndMoreThanOrdinaryMotion) {
    const LiveResult result = small_run();
    const DisplayRecord* refresh = telling_refresh(result);
    ASSERT_NE(refresh, nullptr);
    EXPECT_FALSE(refresh->missed());
    // Ages of the shown: 105, 115, 125, then 105 to 145: the median is 115, and within 10 % of it lie 105 to 125.
    const double age_ms = to_ms(refresh->photon - refresh->frame_pose_sampled);
    EXPECT_GE(age_ms, 104.0);
    EXPECT_LE(age_ms, 126.0);
    EXPECT_EQ(refresh->frame_index, 2u);
}

}  // namespace
}  // namespace lw
