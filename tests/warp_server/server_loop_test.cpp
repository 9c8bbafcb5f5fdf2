#include "warp_server/server_loop.h"
#include "warp_server/frame_warper.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/warp_server/allocation_count.h"
#include "tests/warp_server/simulated_display.h"
#include "warp_server/virtual_display.h"

namespace lw {
namespace {

constexpr double kHz = 90.0;

// A head that walks along x at 1 m/s: its position says when it was sampled.
Pose walking(TimePoint time) { return {glm::dvec3{seconds_of(time), 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}}; }

// The server on a simulated machine. Work and lateness may be changed while it runs.
struct Rig {
    explicit Rig(std::optional<Duration> fixed_lead = {}, std::function<Pose(TimePoint)> pose = walking)
        : head{std::move(pose)},
          warper{std::make_unique<TimedMethod>(clock, [this] { return work(); }), std::make_unique<test::NoFill>()},
          loop{ServerParts{clock, exchange, head, movers, predictor, warper, display}, settings(fixed_lead)} {}

    using TimedMethod = test::TimedMethod;

    static ServerSettings settings(std::optional<Duration> fixed_lead) {
        ServerSettings result;
        result.camera.size_px = {4, 4};
        result.pacer.fixed_lead = fixed_lead;
        return result;
    }
    void show(int refreshes) {
        for (int i = 0; i < refreshes; ++i) loop.show_next();
    }
    void begin() {
        exchange.publish(test::plain_frame(1, TimePoint{}, Rgba8{10, 20, 30, 255}));
        loop.show_next();  // the warm-up
    }
    [[nodiscard]] const TimedMethod& method() const { return dynamic_cast<const TimedMethod&>(warper.method()); }

    std::function<Duration()> work = [] { return from_ms(2.0); };
    test::SimulatedClock clock;
    FrameExchange exchange;
    test::FormulaHeadFeed head;
    test::StillMovers movers{3};
    test::NewestSample predictor;
    FrameWarper warper;
    VirtualDisplay display{TimePoint{}, kHz, {4, 4}};
    ServerLoop loop;
};

TEST(ServerLoop, NothingIsShownOrCountedBeforeTheFirstFrame) {
    Rig rig;
    rig.show(10);
    EXPECT_TRUE(rig.loop.records().empty());
    EXPECT_EQ(rig.display.picture_refresh().number, 0u);
    EXPECT_GE(seconds_of(rig.clock.now()), 9.0 / kHz);
}

TEST(ServerLoop, EveryRefreshAfterTheFirstFrameGetsARecord) {
    Rig rig;
    rig.begin();
    rig.show(200);
    const auto& records = rig.loop.records();
    ASSERT_EQ(records.size(), 200u);
    for (std::size_t i = 1; i < records.size(); ++i) EXPECT_EQ(records[i].refresh, records[i - 1].refresh + 1);
    EXPECT_EQ(count_misses(records).missed, 0u);
    EXPECT_EQ(rig.display.picture().at(2, 2), (Rgba8{10, 20, 30, 255}));
    EXPECT_EQ(rig.method().last_mover_count, 3u);
}

TEST(ServerLoop, TheTimesOfARefreshAreInOrder) {
    Rig rig;
    rig.begin();
    rig.show(50);
    for (const DisplayRecord& record : rig.loop.records()) {
        ASSERT_TRUE(record.presented);
        EXPECT_LE(record.frame_pose_sampled, record.pose_sampled);
        EXPECT_LE(record.pose_sampled, record.latched);
        EXPECT_LE(record.planned_wake, record.latched);
        EXPECT_LE(record.latched, record.warp_begin);
        EXPECT_LT(record.warp_begin, record.warp_end);
        EXPECT_LE(record.warp_end, *record.presented);
        EXPECT_LE(*record.presented, record.scanout_begin);
        EXPECT_LT(record.scanout_begin, record.photon);
        EXPECT_EQ(record.warp_time(), from_ms(2.0));
    }
}

TEST(ServerLoop, WarpsWithTheNewestHeadSampleAtTheLatch) {
    Rig rig{from_ms(5.0)};
    rig.begin();
    rig.show(30);
    const DisplayRecord& last = rig.loop.records().back();
    EXPECT_EQ(last.scanout_begin - last.latched, from_ms(5.0));
    EXPECT_LT(last.latched - last.pose_sampled, from_ms(1.0));  // the tracker's period
    EXPECT_NEAR(rig.method().last_target.world_from_eye.position_m.x, seconds_of(last.pose_sampled), 1e-12);
}

TEST(ServerLoop, LatchesTheNewestFrame) {
    Rig rig;
    rig.begin();
    rig.show(5);
    rig.exchange.publish(test::plain_frame(2, rig.clock.now(), Rgba8{1, 1, 1, 255}));
    rig.exchange.publish(test::plain_frame(3, rig.clock.now(), Rgba8{2, 2, 2, 255}));
    rig.show(1);
    EXPECT_EQ(rig.loop.records().back().frame_index, 3u);
    EXPECT_EQ(rig.display.picture().at(0, 0), (Rgba8{2, 2, 2, 255}));
    EXPECT_EQ(rig.loop.frames_shown(), 2u);
}

TEST(ServerLoop, ASlowWarpIsItsOwnFault) {
    Rig rig{from_ms(5.0)};
    rig.begin();
    rig.show(5);
    rig.work = [] { return from_ms(7.0); };
    rig.show(1);
    const DisplayRecord& record = rig.loop.records().back();
    EXPECT_TRUE(record.missed());
    EXPECT_EQ(record.cause, MissCause::own);
}

TEST(ServerLoop, ALateWakeupIsToldFromASlowWarp) {
    Rig rig{from_ms(5.0)};
    rig.begin();
    rig.show(5);
    rig.clock.lateness = [] { return from_ms(4.0); };
    rig.show(1);
    EXPECT_TRUE(rig.loop.records().back().missed());
    EXPECT_EQ(rig.loop.records().back().cause, MissCause::late_wakeup);
}

TEST(ServerLoop, WakingAfterTheScanoutMakesNoPictureForIt) {
    Rig rig{from_ms(5.0)};
    rig.begin();
    rig.show(5);
    const std::uint64_t before = rig.loop.records().back().refresh;
    rig.clock.lateness = [] { return from_ms(40.0); };
    rig.show(1);
    rig.clock.lateness = nullptr;
    rig.show(1);
    const auto& records = rig.loop.records();
    // Woken 40 ms late for refresh before + 1: that one and the three after it passed.
    EXPECT_EQ(records.back().refresh, before + 5);
    EXPECT_FALSE(records.back().missed());
    const MissCounts counts = count_misses(records);
    EXPECT_EQ(counts.missed, 4u);
    EXPECT_EQ(counts.late_wakeup, 4u);
    EXPECT_EQ(counts.own, 0u);
    EXPECT_EQ(counts.refreshes, records.size());
    EXPECT_FALSE(records[records.size() - 2].presented);
}

TEST(ServerLoop, AWarpLongerThanAPeriodCountsEveryRefreshItSkips) {
    Rig rig;
    rig.begin();
    rig.work = [] { return from_ms(30.0); };
    rig.show(60);
    const auto& records = rig.loop.records();
    for (std::size_t i = 1; i < records.size(); ++i) ASSERT_EQ(records[i].refresh, records[i - 1].refresh + 1);
    const MissCounts counts = count_misses(records);
    EXPECT_EQ(counts.late_wakeup, 0u);
    // Three periods hold one picture.
    EXPECT_GE(counts.own, counts.refreshes * 2 / 3 - 2);
    // Once it has learnt how long the work takes, its pictures are there when they are meant to be seen.
    EXPECT_FALSE(records.back().missed());
}

TEST(ServerLoop, ABadHeadPoseHoldsTheLastGoodOne) {
    bool bad = false;
    Rig rig{from_ms(5.0), [&bad](TimePoint time) {
                Pose pose = walking(time);
                if (bad) pose.position_m.y = std::numeric_limits<double>::quiet_NaN();
                return pose;
            }};
    rig.begin();
    rig.show(3);
    const Pose good = rig.loop.records().back().world_from_head;
    const TimePoint good_sample = rig.loop.records().back().pose_sampled;
    bad = true;
    rig.show(2);
    EXPECT_EQ(rig.loop.bad_head_poses(), 2u);
    EXPECT_EQ(rig.loop.records().back().world_from_head, good);
    // Its age is that of the sample it rests on.
    EXPECT_EQ(rig.loop.records().back().pose_sampled, good_sample);
    bad = false;
    rig.show(1);
    EXPECT_EQ(rig.loop.bad_head_poses(), 2u);
    EXPECT_GT(rig.loop.records().back().world_from_head.position_m.x, good.position_m.x);
}

TEST(ServerLoop, NoAllocationPerRefresh) {
    Rig rig;
    rig.begin();
    rig.show(20);
    const std::size_t before = test::allocations_on_this_thread();
    rig.show(100);
    EXPECT_EQ(test::allocations_on_this_thread(), before);
}

TEST(ServerLoop, EndsWhenAskedTo) {
    Rig rig;
    rig.begin();
    rig.work = [&rig] {
        if (rig.loop.records().size() == 20) rig.loop.request_stop();
        return from_ms(2.0);
    };
    rig.loop.run();
    EXPECT_EQ(rig.loop.records().size(), 21u);
}

TEST(SeenLatencies, AMissedRefreshIsChargedWhatWasOnScreen) {
    std::vector<DisplayRecord> records(4);
    for (std::size_t i = 0; i < records.size(); ++i) {
        const auto number = static_cast<Duration::rep>(i);
        records[i].refresh = i;
        records[i].scanout_begin = TimePoint{number * from_ms(10.0)};
        records[i].photon = records[i].scanout_begin + from_ms(5.0);
        records[i].pose_sampled = records[i].scanout_begin - from_ms(4.0);
        records[i].frame_pose_sampled = TimePoint{from_ms(-100.0)};
        records[i].presented = records[i].scanout_begin - from_ms(1.0);
    }
    records[1].presented = records[1].scanout_begin + from_ms(2.0);  // late: seen at refresh 2, if nothing newer were
    records[2].presented = std::nullopt;
    const SeenLatencies seen = seen_latencies(records);
    ASSERT_EQ(seen.motion_to_photon.size(), 4u);
    EXPECT_EQ(seen.motion_to_photon[0], from_ms(9.0));
    EXPECT_EQ(seen.motion_to_photon[1], from_ms(19.0));  // picture 0 once more
    EXPECT_EQ(seen.motion_to_photon[2], from_ms(19.0));  // picture 1, a period late
    EXPECT_EQ(seen.motion_to_photon[3], from_ms(9.0));
    EXPECT_EQ(seen.frame_age[3], from_ms(135.0));
}

}  // namespace
}  // namespace lw
