#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <random>
#include <utility>
#include <vector>

#include "tests/warp_server/simulated_display.h"
#include "tests/warp_server/synthetic_layers.h"
#include "warp_server/frame_warper.h"
#include "warp_server/server_loop.h"
#include "warp_server/virtual_display.h"

namespace lw {
namespace {

Camera camera_90_deg(glm::ivec2 size_px) {
    Camera camera;
    camera.size_px = size_px;
    return camera;
}

TEST(Strips, CoverThePictureOnce) {
    for (const int height_px : {8, 100, 1024, 1023}) {
        int next_px = 0;
        for (int index = 0; index < 7; ++index) {
            const Strip strip = strip_at(index, 7, height_px);
            EXPECT_EQ(strip.top_px, next_px);
            next_px += strip.height_px;
        }
        EXPECT_EQ(next_px, height_px);
    }
}

TEST(Strips, ASlotIsAShareOfARefresh) {
    const VirtualDisplay display{TimePoint{}, 100.0, {8, 8}};
    EXPECT_EQ(next_slot(display, TimePoint{}, 1).number, display.next_refresh(TimePoint{}).number);
    TimePoint now{};
    for (std::uint64_t expected = 1; expected < 50; ++expected) {
        const Refresh slot = next_slot(display, now, 4);
        ASSERT_EQ(slot.number, expected);
        ASSERT_EQ(slot.scanout_begin, TimePoint{} + from_ms(2.5) * static_cast<Duration::rep>(expected));
        ASSERT_EQ(slot.photon(), slot.scanout_begin + from_ms(1.25));
        now = slot.scanout_begin;
    }
}

// A head that holds still sees no strips: their pictures put together are the whole one, pixel for pixel. The rays of a
// strip's camera differ from the whole one's by rounding, which moves a source pixel across a target pixel's edge for a
// few in ten thousand.
TEST(Strips, PutTogetherAreTheWholePicture) {
    const Camera source = camera_90_deg({96, 96});
    const Layer layer = test::noise_layer(source);
    Camera camera = source;
    camera.world_from_eye.position_m = {0.01, -0.02, 0.015};
    camera.world_from_eye.orientation = glm::angleAxis(0.03, glm::normalize(glm::dvec3{0.3, 1.0, 0.2}));
    for (const char* method : {"reference", "splat", "rotation"}) {
        const DisplayFrame whole = test::warp_once(method, layer, {camera, {}});
        int different = 0;
        for (int index = 0; index < 8; ++index) {
            const Strip strip = strip_at(index, 8, camera.size_px.y);
            const DisplayFrame part = test::warp_once(method, layer, {camera_of(camera, strip), {}});
            for (int y = 0; y < strip.height_px; ++y) {
                for (int x = 0; x < camera.size_px.x; ++x) {
                    const bool same = part.coverage.at(x, y) == whole.coverage.at(x, strip.top_px + y) &&
                                      (part.coverage.at(x, y) == Coverage::hole ||
                                       part.colour.at(x, y) == whole.colour.at(x, strip.top_px + y));
                    if (!same) ++different;
                }
            }
        }
        EXPECT_LE(different, 96 * 96 / 1000) << method;
    }
}

struct StripRig {
    StripRig(int strips, double work_ms) : StripRig{strips, [work_ms] { return from_ms(work_ms); }, TimePoint{}} {}
    StripRig(int strips, std::function<Duration()> work, TimePoint start, int pictures = 400)
        : warper{std::make_unique<test::TimedMethod>(clock, std::move(work)), std::make_unique<test::NoFill>()},
          display{start, 90.0, {16, 64}},
          loop{ServerParts{clock, exchange, head, movers, predictor, warper, display}, settings(strips)} {
        exchange.publish(test::plain_frame(1, TimePoint{}, Rgba8{10, 20, 30, 255}));
        for (int i = 0; i < pictures; ++i) loop.show_next();
    }
    static ServerSettings settings(int strips) {
        ServerSettings result;
        result.camera.size_px = {16, 64};
        result.strips = strips;
        return result;
    }

    test::SimulatedClock clock;
    FrameExchange exchange;
    test::FormulaHeadFeed head{[](TimePoint time) { return Pose{{seconds_of(time), 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}}; }};
    test::StillMovers movers{0};
    test::NewestSample predictor;
    FrameWarper warper;
    VirtualDisplay display;
    ServerLoop loop;
};

TEST(Strips, EachHasItsOwnPoseJustAheadOfItsScanout) {
    const StripRig rig{8, 0.4};
    const auto& parts = rig.loop.records();
    const DisplayRecord& last = parts.back();
    const DisplayRecord& before = parts[parts.size() - 2];
    EXPECT_EQ(last.refresh, before.refresh + 1);
    EXPECT_GT(last.pose_sampled, before.pose_sampled);
    // Its work, and its time to be ready in.
    EXPECT_LT(to_ms(last.scanout_begin - last.latched), 0.41 + 1e3 / 90.0 / 8.0);
    EXPECT_NEAR(to_ms(last.photon - last.scanout_begin), 0.5e3 / 90.0 / 8.0, 1e-5);
    EXPECT_EQ(rig.display.picture().at(3, 60), (Rgba8{10, 20, 30, 255}));
    EXPECT_EQ(count_misses(worst_strips(parts, 8)).missed, 0u);
}

TEST(Strips, ARehearsalTellsWhatTheSlowestTakesAtItsBest) {
    // The third warp of four of each of two strips is disturbed, and the lower one is harder.
    int warps = 0;
    StripRig rig{2,
                 [&] {
                     const int warp = warps++;
                     return from_ms(warp % ServerLoop::kWarmUpWarps == 2 ? 9.0 : warp < 4 ? 1.0 : 1.5);
                 },
                 TimePoint{}, 0};
    EXPECT_EQ(rig.loop.rehearse(), from_ms(1.5));
    EXPECT_EQ(warps, 2 * ServerLoop::kWarmUpWarps);
    EXPECT_TRUE(rig.loop.records().empty());
    rig.loop.show_next();
    EXPECT_EQ(warps, 2 * ServerLoop::kWarmUpWarps + 1) << "once is enough";
}

TEST(Strips, WorkThatNeedsMostOfAStripsTimeIsStillInTime) {
    // 1.2 ms of the 1.39 ms that a strip has.
    const StripRig rig{8, 1.2};
    const auto refreshes = worst_strips(rig.loop.records(), 8);
    EXPECT_LE(count_misses(refreshes).missed, 2u) << "while it learns";
    EXPECT_FALSE(refreshes.back().missed());
}

TEST(Strips, WorkThatIsTooLongForAStripIsAMissOfItsRefresh) {
    const StripRig rig{8, 3.0};
    const auto refreshes = worst_strips(rig.loop.records(), 8);
    const MissCounts counts = count_misses(refreshes);
    EXPECT_EQ(counts.missed, counts.refreshes);
    EXPECT_EQ(counts.late_wakeup, 0u);
}

// On a machine that is too slow for every slot, no strip is left as it was while another one is made again and again.
TEST(Strips, TakeTurnsWhereTheWorkIsTooSlow) {
    for (const int strips : {2, 3, 8}) {
        for (const double work_ms : {1.5, 3.0, 6.0, 7.3, 9.0, 12.0, 25.0}) {
            const StripRig rig{strips, work_ms};
            std::vector<int> made(static_cast<std::size_t>(strips), 0);
            for (const DisplayRecord& part : rig.loop.records()) {
                if (part.presented) ++made[part.refresh % made.size()];
            }
            const auto [fewest, most] = std::ranges::minmax(made);
            const auto& parts = rig.loop.records();
            for (std::size_t i = 1; i < parts.size(); ++i) {
                ASSERT_EQ(parts[i].refresh, parts[i - 1].refresh + 1) << strips << " strips of " << work_ms << " ms";
            }
            EXPECT_LE(most - fewest, 8) << strips << " strips of " << work_ms << " ms";
            EXPECT_GT(fewest, 0);
        }
    }
}

// Whatever is passed over, every slot is written down once: by their numbers, since the times of a slot that lies some
// slots ahead are rounded.
TEST(Strips, AreAllWrittenDownOnce) {
    for (const int strips : {1, 2, 3, 8}) {
        std::mt19937 random{17};
        std::exponential_distribution<double> work_ms{strips / 6.0};
        const StripRig rig{strips, [&] { return from_ms(work_ms(random)); }, TimePoint{} + Duration{1234567}};
        const auto& parts = rig.loop.records();
        for (std::size_t i = 1; i < parts.size(); ++i) {
            ASSERT_EQ(parts[i].refresh, parts[i - 1].refresh + 1) << strips << " strips";
        }
    }
}

}  // namespace
}  // namespace lw
