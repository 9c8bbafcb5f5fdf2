#include <gtest/gtest.h>

#include <cmath>

#include "apps/billboard_bench_figures.h"

namespace lw {
namespace {

SweepPoint sweep_point(const char* mode, double redraws, double flip) {
    SweepPoint point;
    point.mode = mode;
    point.criterion = "error";
    point.redraws_per_frame = redraws;
    point.flip_truth = flip;
    return point;
}

TrialFrame frame_of(double ms, std::uint64_t updated, std::uint64_t replaceable) {
    TrialFrame frame;
    frame.frame_ms = ms;
    frame.wall_ms = 2.0 * ms;
    frame.update_ms = static_cast<double>(updated) * 0.5;
    frame.counters.updated = updated;
    frame.counters.triangles_in_view = 100;
    frame.counters.triangles_replaceable = replaceable;
    return frame;
}

TEST(BillboardBench, RedrawsForAFlipAreInterpolated) {
    const std::vector<SweepPoint> curve{sweep_point("flat", 100, 0.01), sweep_point("flat", 10, 0.04),
                                        sweep_point("flat", 40, 0.02)};
    EXPECT_DOUBLE_EQ(*redraws_for_flip(curve, 0.03), 25.0);
    EXPECT_DOUBLE_EQ(*redraws_for_flip(curve, 0.015), 70.0);
    EXPECT_DOUBLE_EQ(*redraws_for_flip(curve, 0.05), 10.0) << "the fewest that were tried do";
    EXPECT_FALSE(redraws_for_flip(curve, 0.005).has_value()) << "nearer than flat quads get";
    EXPECT_FALSE(redraws_for_flip({}, 0.02).has_value());
}

TEST(BillboardBench, SharesOfRedrawsAreTakenAtTheErrorOfFlatOnes) {
    BillboardBench bench;
    bench.caps = {sweep_point("flat", 100, 0.01), sweep_point("flat", 50, 0.03), sweep_point("warped", 80, 0.02),
                  sweep_point("warped", 4, 0.03)};
    bench.caps[1].value = 2.0;
    const std::vector<RedrawShare> shares = redraw_shares(bench.caps);
    ASSERT_EQ(shares.size(), 2U);
    EXPECT_FALSE(shares[0].warped_redraws.has_value());
    EXPECT_TRUE(std::isinf(shares[0].share()));
    EXPECT_DOUBLE_EQ(shares[1].share(), 0.08);
    bench.path.trials = {{"ours", {}}};
    EXPECT_DOUBLE_EQ(figures_of(bench).redraw_ratio, 0.08) << "at the default cap, 2 px";
}

TEST(BillboardBench, FiguresCountOnlyEligibleFrames) {
    BillboardBench bench;
    bench.path.meshes = {frame_of(100, 0, 0), frame_of(100, 0, 0), frame_of(100, 0, 0), frame_of(100, 0, 0)};
    bench.path.trials = {
        {"ours", {frame_of(10, 3, 100), frame_of(25, 64, 80), frame_of(90, 65, 100), frame_of(95, 0, 79)}}};
    bench.path.quality = {{0.0, 0.9, 0.95, 0.98}, {1.0, 0.96, 0.95, 0.94}, {2.0, 0.97, 0.97, 0.96}, {3.0, 1, 1, 0.96}};
    bench.overview.meshes = {frame_of(100, 0, 0), frame_of(100, 0, 0)};
    bench.overview.ours = {frame_of(5, 0, 100), frame_of(8, 100, 100)};
    const BillboardFigures figures = figures_of(bench);
    EXPECT_EQ(figures.eligible, 3U) << "too many updates, too few replaceable triangles";
    EXPECT_DOUBLE_EQ(figures.speedup_min_eligible, 4.0);
    EXPECT_DOUBLE_EQ(figures.speedup_min_eligible_processor, 4.0);
    EXPECT_DOUBLE_EQ(figures.speedup_best_100, 12.5) << "fewer than 100 frames: the least of all";
    EXPECT_NEAR(figures.ssim_mean, 0.96, 1e-12);
    EXPECT_DOUBLE_EQ(figures.ssim_min, 0.94);
}

LikenessPoint likeness(PairSchedule schedule, bool flat_blended, int fresh, int equal, int better, int worse) {
    LikenessPoint point;
    point.schedule = schedule;
    point.flat_blended = flat_blended;
    point.fresh = fresh;
    point.equal = equal;
    point.better = better;
    point.worse = worse;
    point.worst_loss = 0.001 * worse;
    return point;
}

TEST(BillboardBench, FramesOfFreshQuadsSayNothingAboutFlatAndWarped) {
    BillboardBench bench;
    bench.likeness = {
        likeness(PairSchedule::angles, false, 10, 1, 6, 1), likeness(PairSchedule::angles, false, 0, 0, 12, 0),
        likeness(PairSchedule::warped_error, false, 0, 0, 3, 1), likeness(PairSchedule::angles, true, 0, 0, 0, 20)};
    bench.path.trials = {{"ours", {}}};
    const BillboardFigures figures = figures_of(bench);
    EXPECT_DOUBLE_EQ(figures.warped_better, 0.9) << "18 of 20; equal frames count against warped ones";
    EXPECT_DOUBLE_EQ(figures.warped_better_by_error, 0.75);
    EXPECT_DOUBLE_EQ(figures.warped_loss, 0.001);
    EXPECT_EQ(share_better({}), 0.0);
}

ColourImage grey(int level) {
    return ColourImage{{8, 8},
                       Rgba8{static_cast<std::uint8_t>(level), static_cast<std::uint8_t>(level),
                             static_cast<std::uint8_t>(level), 255}};
}

TEST(BillboardBench, FlickerIsChangeBeyondTheTruths) {
    EXPECT_EQ(flicker_energy(grey(10), grey(10), grey(10), grey(90)), 0.0) << "too little change is no flicker";
    EXPECT_EQ(flicker_energy(grey(10), grey(61), grey(10), grey(61)), 0.0);
    EXPECT_NEAR(flicker_energy(grey(0), grey(102), grey(0), grey(51)), 0.2 * 0.2, 1e-12);
    // A checker of single pixels that swaps sides looks the same from cell to cell.
    ColourImage even = grey(0);
    ColourImage odd = grey(0);
    for (int y = 0; y < 8; ++y) {
        for (int x = 0; x < 8; ++x) ((x + y) % 2 == 0 ? even : odd).at(x, y) = {255, 255, 255, 255};
    }
    EXPECT_NEAR(flicker_energy(even, odd, grey(0), grey(0)), 0.0, 1e-12);
    EXPECT_NEAR(change_energy(even, odd, 4), 0.0, 1e-12);
    EXPECT_NEAR(change_energy(even, odd, 1), 1.0, 1e-12);
    EXPECT_NEAR(change_energy(grey(0), grey(51), 4), 0.2 * 0.2, 1e-12);
}

}  // namespace
}  // namespace lw
